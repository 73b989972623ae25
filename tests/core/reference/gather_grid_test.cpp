#include "core/reference/gather_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "tests/support/random_direction.h"

namespace caustics {
namespace {

using support::random_direction;

Vec3 random_vector(Rng& rng, float half) {
    const float x = rng.next(), y = rng.next(), z = rng.next();
    return half * (2 * Vec3(x, y, z) - Vec3::Ones());
}

// The definition: in the tangent plane within the radius, not farther from the plane than it, on a
// surface that faces within 60 degrees of the disc's.
bool in_disc(const ReceiverPoint& p, float radius, const Deposit& d) {
    const Vec3 offset = d.position - p.position;
    const float height = p.geometric_normal.dot(offset);
    const float across2 = (offset - height * p.geometric_normal).squaredNorm();
    const float thickness = d.shape == p.shape ? radius : radius / 100;
    return d.wi.dot(p.geometric_normal) > 0 && d.geometric_normal.dot(p.geometric_normal) > 0.5F &&
           std::abs(height) <= thickness && across2 <= radius * radius;
}

void expect_same_as_scan(const Vec3& centre, float smallest, float largest) {
    Rng rng(1, Stage::test, 0);
    std::vector<ReceiverPoint> points(300);
    std::vector<float> radii;
    for (ReceiverPoint& p : points) {
        p.position = centre + random_vector(rng, 1);
        p.geometric_normal = random_direction(rng);
        p.shape = rng.next() < 0.8F ? 1 : 2;
        radii.push_back(smallest * std::pow(largest / smallest, rng.next()));
    }
    const GatherGrid grid(points, radii);
    std::size_t found_in_all = 0;
    for (int i = 0; i < 5000; ++i) {
        // Half of the tries near a point, where small discs are found too.
        const auto near = static_cast<std::size_t>(rng.next() * 300);
        Deposit d;
        d.position = i % 2 == 0 ? Vec3(centre + random_vector(rng, 1.3F))
                                : Vec3(points[near].position + random_vector(rng, radii[near]));
        d.wi = random_direction(rng);
        d.shape = 1;
        d.geometric_normal = i % 4 == 1 ? points[near].geometric_normal : random_direction(rng);
        std::vector<std::uint32_t> found, scanned;
        grid.for_each_containing(d, [&](std::uint32_t at) { found.push_back(at); });
        for (std::uint32_t at = 0; at < points.size(); ++at)
            if (in_disc(points[at], radii[at], d)) scanned.push_back(at);
        ASSERT_EQ(found, scanned) << d.position.transpose();
        found_in_all += found.size();
    }
    EXPECT_GT(found_in_all, 500U);
}

TEST(GatherGrid, FindsTheSameDiscsAsALinearScan) {
    expect_same_as_scan(Vec3::Zero(), 0.1F, 0.1F);
    expect_same_as_scan(Vec3::Zero(), 0.001F, 0.5F);
    expect_same_as_scan(Vec3(100, -200, 300), 0.01F, 0.3F);
    expect_same_as_scan(Vec3::Zero(), 1, 20);
}

TEST(GatherGrid, OfNoPointsFindsNothing) {
    const GatherGrid grid({}, {});
    grid.for_each_containing(Deposit(), [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace caustics

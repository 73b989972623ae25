#include "core/reference/direction_mixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

constexpr std::size_t rows = 16;
constexpr std::size_t columns = 24;
constexpr int draw_count = 60'000;

std::size_t cell_of(const Vec3& w) {
    const double turn = std::atan2(static_cast<double>(w.y()), static_cast<double>(w.x()));
    const auto cell = [](double u, std::size_t count) {
        return static_cast<std::size_t>(std::clamp(u, 0.0, 0.999999) * static_cast<double>(count));
    };
    return cell((static_cast<double>(w.z()) + 1) / 2, rows) * columns +
           cell(turn / (2 * pi_d) + 0.5, columns);
}

// Counts of directions by cell of the sphere, with those lost below the surface in a last one, against
// the density's integrals over a fine grid, which know the rims of cones to some thousandths.
double p_value(const DirectionMixture& mixture, std::uint64_t seed) {
    constexpr int fine = 960;  // whole cells
    std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
    for (int i = 0; i < fine; ++i)
        for (int j = 0; j < fine; ++j) {
            const double z = 2 * (i + 0.5) / fine - 1;
            const double turn = 2 * pi_d * (j + 0.5) / fine;
            const double r = std::sqrt(1 - z * z);
            const Vec3 w = Vec3d(r * std::cos(turn), r * std::sin(turn), z).cast<float>();
            expected[cell_of(w)] +=
                draw_count * 4 * pi_d / (fine * fine) * static_cast<double>(mixture.pdf_w(w));
        }
    expected.back() = draw_count - std::accumulate(expected.begin(), expected.end(), 0.0);
    EXPECT_GT(expected.back(), -0.003 * draw_count);
    expected.back() = std::max(0.0, expected.back());
    Rng rng(seed, Stage::test, 0);
    for (int i = 0; i < draw_count; ++i) {
        const auto wi = mixture.sample(rng);
        counts[wi ? cell_of(*wi) : rows * columns] += 1;
    }
    return support::chi_square_p_value(counts, expected);
}

ReceiverPoint seen_from_aside(const Bsdf& bsdf) {
    ReceiverPoint point;
    point.position = Vec3(0.5F, 0, 0);
    point.geometric_normal = point.shading_normal = Vec3(0.1F, -0.2F, 1).normalized();
    point.wo = Vec3(0.6F, 0.3F, 0.7F).normalized();
    point.bsdf = &bsdf;
    return point;
}

// No caster outside, one, and three of which two overlap and one lies partly below the surface.
TEST(DirectionMixture, SamplesFollowTheirDensity) {
    const BoundingSphere round{Vec3(0, 0, 1), 3};
    const BoundingSphere near{Vec3(0, 1, 2), 1};
    const BoundingSphere behind{Vec3(-0.5F, 2, 3.5F), 1.5F};
    const BoundingSphere low{Vec3(-3, -1, 0.5F), 1.2F};
    const std::vector<std::vector<BoundingSphere>> casters = {
        {round}, {near}, {near, behind, low, round}};
    std::uint64_t seed = 1;
    for (const Bsdf& bsdf : {support::diffuse(0.5F), support::schlick(0.5F, 0.2F)}) {
        const ReceiverPoint point = seen_from_aside(bsdf);
        for (const auto& some : casters)
            EXPECT_GT(p_value(DirectionMixture(some, point), seed++), 1e-3) << some.size();
    }
}

}  // namespace
}  // namespace caustics

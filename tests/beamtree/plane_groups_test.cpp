#include "beamtree/cones/plane_groups.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/sampling.h"

namespace caustics::beamtree {
namespace {

// Beams of three rays each, by their directions.
BeamSet beams_along(const std::vector<std::array<Vec3, 3>>& beams) {
    BeamSet set;
    for (const std::array<Vec3, 3>& directions : beams) {
        const auto first = static_cast<std::uint32_t>(set.rays.size());
        for (const Vec3& direction : directions)
            set.rays.push_back({Vec3::Zero(), direction.normalized()});
        Beam beam;
        beam.corners = {first, first + 1, first + 2, Beam::none};
        set.beams.push_back(beam);
    }
    return set;
}

std::array<Vec3, 3> spread_round(const Vec3& axis) {
    const Vec3 aside = axis.unitOrthogonal();
    return {axis + 0.5F * aside, axis - 0.5F * aside, axis + 0.5F * axis.cross(aside)};
}

std::vector<Vec3> axes() {
    return {Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
            -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};
}

TEST(PlaneGroups, AreOneAcrossTheAxisThatAllRaysRunDown) {
    for (const Vec3& axis : axes()) {
        const auto groups = fixed_planes(beams_along({spread_round(axis), spread_round(axis)}));
        ASSERT_EQ(groups.size(), 1U);
        EXPECT_EQ(groups[0].normal, std::optional<Vec3>(-axis));
        EXPECT_EQ(groups[0].beams, (std::vector<std::uint32_t>{0, 1}));
    }
}

TEST(PlaneGroups, AreOneAcrossTheMiddleOfACapThatHoldsAllRays) {
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
    const auto groups = fixed_planes(beams_along({{x, x, x}, {y, y, x}}));
    ASSERT_EQ(groups.size(), 1U);
    EXPECT_EQ(groups[0].beams.size(), 2U);
    EXPECT_LT((groups[0].normal.value() + (x + y).normalized()).norm(), 1e-6F);
}

TEST(PlaneGroups, AreOneForEachAxisAndOneForBeamsThatSpreadTooFar) {
    std::vector<std::array<Vec3, 3>> beams;
    for (const Vec3& axis : axes()) beams.push_back(spread_round(axis));
    beams.push_back({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
    const auto groups = fixed_planes(beams_along(beams));
    ASSERT_EQ(groups.size(), 7U);
    for (std::uint32_t i = 0; i < 6; ++i) {
        EXPECT_EQ(groups[i].normal, std::optional<Vec3>(-axes()[i]));
        EXPECT_EQ(groups[i].beams, std::vector<std::uint32_t>{i});
    }
    EXPECT_FALSE(groups[6].normal);
    EXPECT_EQ(groups[6].beams, std::vector<std::uint32_t>{6});
}

// Caps as wide as a fixed plane allows, but for rounding: its rays all come down to it steeply enough.
TEST(PlaneGroups, HoldNoRayThatComesDownLessThanTheLeastSine) {
    Rng rng(3, Stage::test, 0);
    int of_caps = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3d axis = uniform_cap(2, rng.next(), rng.next()).cast<double>().normalized();
        const double cosine = static_cast<double>(least_sine + 4e-6F * rng.next() - 2e-6F);
        const double sine = std::sqrt(1 - cosine * cosine);
        const Vec3d s = axis.unitOrthogonal();
        const Vec3d t = axis.cross(s);
        BeamSet set;
        for (const Vec3d& aside : {s, Vec3d(-s), t})
            set.rays.push_back({Vec3::Zero(), (cosine * axis + sine * aside).cast<float>()});
        Beam beam;
        beam.corners = {0, 1, 2, Beam::none};
        set.beams = {beam};
        for (const PlaneGroup& group : fixed_planes(set)) {
            if (!group.normal) continue;
            of_caps += group.normal->cwiseAbs().maxCoeff() < 1;
            for (const VertexRay& ray : set.rays)
                EXPECT_GE(-group.normal->cast<double>().dot(ray.direction.cast<double>()),
                          static_cast<double>(least_sine));
        }
    }
    EXPECT_GT(of_caps, 500);
}

}  // namespace
}  // namespace caustics::beamtree

#include "beamtree/cones/plane_groups.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace caustics::beamtree

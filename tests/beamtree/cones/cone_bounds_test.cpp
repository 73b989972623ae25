#include "beamtree/cones/cone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/beamtree/cones/ray_bundle.h"

namespace caustics::beamtree {
namespace {

/// Of small and large squares near the origin and far from it, of rays that come together, go apart or do neither.
std::vector<RayBundle> bundles() {
    std::vector<RayBundle> all;
    for (const Vec3d& centre : {Vec3d(0, 0, 0), Vec3d(0, 0, 5000), Vec3d(-4321.7, 0, 0.3),
                                Vec3d(1234.56, -7890.12, 345.67)})
        for (const double half : {0.0, 1e-3, 1.0})
            for (const double apart : {0.0, 0.6, -0.6})
                for (const double around : {0.0, 0.2})
                    for (const double lifted : {0.0, half / 2})
                        all.push_back({centre, half, apart, around, lifted});
    return all;
}

// A ray's own start is the farthest place that a ball must reach to, and its way the edge of a cone: there rounding shows.
TEST(ConeBounds, HoldTheRaysThatTheyAreMadeOf) {
    for (const RayBundle& bundle : bundles()) {
        const NodeRays rays = bundle.rays();
        const Cap cap = smallest_cap(rays.directions);
        const SweptSphere swept(rays, cap);
        const SingleCone single(rays, cap);
        const DoubleCone twice = double_cone(rays, cap, 2);
        ASSERT_TRUE(twice.exists());
        for (std::size_t i = 0; i < rays.positions.size(); ++i)
            for (const double distance : {0.0, 1e-4, 0.01, 1.0, 3.0}) {
                const Vec3d p = rays.positions[i] + distance * rays.directions[i];
                const auto where = [&] {
                    return testing::Message()
                           << bundle.centre.transpose() << ", half " << bundle.half << ", apart "
                           << bundle.apart << ", around " << bundle.around << ", lifted "
                           << bundle.lifted << ": ray " << i << " after " << distance << " m";
                };
                EXPECT_TRUE(swept.holds(p)) << where();
                EXPECT_TRUE(single.holds(p)) << where();
                for (const auto& triangle : rays.triangles) {
                    if (std::ranges::find(triangle, i) == triangle.end()) continue;
                    const std::array<Vec3d, 3> corners = {rays.positions[triangle[0]],
                                                          rays.positions[triangle[1]],
                                                          rays.positions[triangle[2]]};
                    EXPECT_TRUE(single.holds(p, corners)) << where();
                }
                EXPECT_TRUE(twice.holds(p, Vec3d::UnitZ()).value_or(true)) << where();
            }
    }
}

TEST(ConeBounds, LeaveOutWhatIsAsideOrBehind) {
    const RayBundle bundle{.half = 0.1, .lifted = 0.5};
    const NodeRays rays = bundle.rays();
    const Cap cap = smallest_cap(rays.directions);
    const SweptSphere swept(rays, cap);
    const SingleCone single(rays, cap);
    const Vec3d inside(0, 0, -1);
    const Vec3d aside(1, 0, -1);
    const Vec3d behind(0, 0, 0.6);
    EXPECT_TRUE(swept.holds(inside));
    EXPECT_FALSE(swept.holds(aside));
    EXPECT_FALSE(swept.holds(behind));
    EXPECT_TRUE(single.holds(inside));
    EXPECT_FALSE(single.holds(aside));
    EXPECT_FALSE(single.holds(behind));
}

// What covers rounding is as small as the beams are.
TEST(DoubleCone, IsAsTightAtAnyScale) {
    for (const double scale : {1e-3, 1.0, 1e3}) {
        const NodeRays rays = RayBundle{.half = scale, .apart = 0.3}.rays();
        const DoubleCone cone = double_cone(rays, smallest_cap(rays.directions), scale);
        ASSERT_TRUE(cone.exists());
        // The neck is the square, and its corners are farthest from the axis.
        const auto held = [&](double times_farther, double below) {
            const double along_side = scale * (1 + 0.3 * std::abs(below)) * times_farther;
            const Vec3d p(along_side, along_side, -scale * below);
            return cone.holds(p, Vec3d::UnitZ()).value();
        };
        EXPECT_TRUE(held(0.99, 0.1)) << scale;
        EXPECT_FALSE(held(1.01, 0.1)) << scale;
        EXPECT_TRUE(held(0.99, 2)) << scale;
        EXPECT_FALSE(held(1.01, 2)) << scale;
        EXPECT_FALSE(held(0.5, -0.05)) << scale;  // behind
    }
}

TEST(DoubleCone, TellsWidthAndSpreadingOfItsWidestBeam) {
    const NodeRays rays = RayBundle{.centre = {3, 4, 0}, .half = 0.3, .apart = 0.2}.rays();
    const DoubleCone cone = double_cone(rays, smallest_cap(rays.directions), 1);
    ASSERT_TRUE(cone.exists());
    // A cell's diagonal; the neck is the square.
    EXPECT_NEAR(cone.width, std::sqrt(2) * 0.3, 1e-5);
    EXPECT_NEAR(cone.spreading, std::sqrt(2) * 0.2, 1e-5);
}

// Beams of rays that hardly part have hardly any slack on tilted planes.
TEST(DoubleCone, IsTightOnTiltedPlanes) {
    const NodeRays rays = RayBundle{.half = 0.1, .apart = 0.01}.rays();
    const DoubleCone cone = double_cone(rays, smallest_cap(rays.directions), 1);
    ASSERT_TRUE(cone.exists());
    const Vec3d normal = Vec3d(1, 0, 1).normalized();
    for (const double depth : {0.5, 2.0, 10.0}) {
        const double farthest = 0.1 + 0.01 * depth;
        const auto held = [&](double times) {
            return cone.holds({times * farthest, times * farthest, -depth}, normal).value();
        };
        EXPECT_TRUE(held(1)) << depth;
        EXPECT_FALSE(held(1.02)) << depth;
    }
}

TEST(DoubleCone, DoesNotAnswerOnPlanesAlongItsAxis) {
    const NodeRays rays = RayBundle{.half = 0.1}.rays();
    const DoubleCone cone = double_cone(rays, smallest_cap(rays.directions), 1);
    ASSERT_TRUE(cone.exists());
    const Vec3d p(0, 0, -1);
    for (const double from_axis : {0.0, 0.001, 0.01})
        EXPECT_FALSE(cone.holds(p, {std::cos(from_axis), 0, std::sin(from_axis)}));
    EXPECT_TRUE(cone.holds(p, {std::cos(0.1), 0, std::sin(0.1)}));
}

}  // namespace
}  // namespace caustics::beamtree

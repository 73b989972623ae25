#include "beamtree/cones/cone_merging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/beamtree/cones/ray_bundle.h"

namespace caustics::beamtree {
namespace {

// The section of one round cone at its neck is a circle; what holds it is the circle round the square round it.
TEST(ConeMerging, OfOneChildTakesTheCircleRoundTheSquareRoundItsNeck) {
    for (const double apart : {-0.5, 0.2}) {
        const NodeRays rays = RayBundle{.half = 0.5, .apart = apart, .around = 0.1}.rays();
        const MergedCone child = leaf_cone(rays, 3);
        ASSERT_TRUE(child.wide.exists());
        const MergedCone parent = merge_cones(std::span(&child, 1), rays, 3);
        ASSERT_TRUE(parent.wide.exists());
        EXPECT_NEAR(parent.cap.angle(), child.cap.angle(), 1e-6);
        EXPECT_NEAR((parent.wide.neck - child.wide.neck).norm(), 0, 1e-2);
        EXPECT_NEAR(parent.wide.radius / (std::sqrt(2.0F) * child.wide.radius), 1, 1e-3);
        EXPECT_NEAR(parent.wide.tangent / child.wide.tangent, 1, 1e-4);
    }
}

// [CC95 (4)]
TEST(ConeMerging, AddsTheAngleBetweenAxesToThatOfTheChildren) {
    for (const double turned : {0.05, 0.3}) {
        NodeRays both;
        std::vector<MergedCone> children;
        for (const double by : {-turned, turned}) {
            const NodeRays rays =
                RayBundle{.centre = {by, 0, 0}, .half = 0.1, .apart = 0.2, .turned = by}.rays();
            children.push_back(leaf_cone(rays, 2));
            const auto first = static_cast<std::uint32_t>(both.positions.size());
            both.positions.insert(both.positions.end(), rays.positions.begin(),
                                  rays.positions.end());
            both.directions.insert(both.directions.end(), rays.directions.begin(),
                                   rays.directions.end());
            for (const auto& [a, b, c] : rays.triangles)
                both.triangles.push_back({first + a, first + b, first + c});
        }
        const MergedCone parent = merge_cones(children, both, 2);
        const double between =
            std::acos(children[0].cap.axis.dot(children[1].cap.axis)) / 2;  // parent and child
        EXPECT_NEAR(between, turned, 0.01);
        EXPECT_NEAR(parent.cap.angle(),
                    between + std::max(children[0].cap.angle(), children[1].cap.angle()), 1e-6);
        EXPECT_NEAR(parent.cap.axis.z(), -1, 1e-6);
        // Whatever is in one of the children's cones.
        ASSERT_TRUE(parent.wide.exists());
        for (const MergedCone& child : children)
            for (const double depth : {-0.05, 0.0, 0.5, 2.0})
                for (int i = 0; i < 16; ++i) {
                    const double angle = 2 * pi_d * i / 16;
                    const Vec3d axis = child.wide.axis.cast<double>();
                    const Vec3d s = axis.unitOrthogonal();
                    const Vec3d t = axis.cross(s);
                    const double radius = static_cast<double>(child.wide.radius) +
                                          std::abs(depth) * static_cast<double>(child.wide.tangent);
                    const Vec3d p = child.wide.neck.cast<double>() + depth * axis +
                                    radius * (std::cos(angle) * s + std::sin(angle) * t);
                    const double along =
                        (p - parent.wide.neck.cast<double>()).dot(parent.wide.axis.cast<double>());
                    if (along < static_cast<double>(parent.wide.nearest)) continue;
                    EXPECT_TRUE(parent.wide.holds(p, -axis).value_or(true))
                        << turned << " " << depth << " " << i;
                }
    }
}

}  // namespace
}  // namespace caustics::beamtree

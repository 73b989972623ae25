#include "core/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/build_scene.h"

namespace caustics {
namespace {

SceneDesc small_scene() {
    SceneDesc desc;
    desc.lights.push_back(support::point_light({0, 0, 3}, 1));
    desc.lights.push_back(support::directional_light({0, 0, -2}, 1));
    desc.shapes.push_back(support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)));
    desc.shapes.push_back(support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("lamp", 4, 1, false, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(2));
    desc.shapes.push_back(support::horizontal("mirror", -1000, 1, true, support::mirror()));
    return desc;
}

TEST(Scene, ListsLightsCastersAndBounds) {
    const Scene scene(small_scene());
    ASSERT_EQ(scene.lights().size(), 3U);
    EXPECT_TRUE(std::holds_alternative<PointLight>(scene.lights()[0]));
    EXPECT_TRUE(std::holds_alternative<DirectionalLight>(scene.lights()[1]));
    ASSERT_NE(scene.area_light(2), nullptr);
    EXPECT_EQ(scene.area_light(2)->shape, 2U);
    EXPECT_NEAR(scene.area_light(2)->sampler.area(), 4, 1e-9);
    EXPECT_EQ(scene.area_light(0), nullptr);
    EXPECT_EQ(scene.casters(), (std::vector<std::uint32_t>{1, 3}));
    EXPECT_TRUE(scene.bounds().isApprox(Box(Vec3(-2, -2, -1000), Vec3(2, 2, 4))));
    EXPECT_NEAR(scene.diameter(), std::sqrt(16.0F + 16 + 1004 * 1004), 1e-3F);
}

TEST(Scene, RaysStartOnTheSideTheyGoTo) {
    const SegmentEnd end{Vec3(1, 2, 3), Vec3::UnitZ(), 0.5F};
    EXPECT_EQ(offset_origin(end, Vec3(1, 0, 0.1F)), Vec3(1, 2, 3.5F));
    EXPECT_EQ(offset_origin(end, Vec3(1, 0, -0.1F)), Vec3(1, 2, 2.5F));
    EXPECT_EQ(spawn_ray({Vec3(1, 2, 3)}, Vec3::UnitX()).origin, Vec3(1, 2, 3));
}

TEST(Scene, LinesOfSightEndAtTheirSurfaces) {
    const Scene scene(small_scene());
    const auto end = [&](std::uint32_t shape, const Vec3& p) {
        return SegmentEnd{p, Vec3::UnitZ(),
                          support::surface_offset(scene, shape, p, Vec3::UnitZ())};
    };
    // Past the ball, and through it.
    EXPECT_FALSE(scene.occluded(end(0, {1.5F, 0, 0}), end(2, {0.9F, 0, 4})));
    EXPECT_TRUE(scene.occluded(end(0, {0, 0, 0}), end(2, {0, 0, 4})));
    EXPECT_FALSE(scene.occluded(end(0, {1.5F, 0, 0}), SegmentEnd{Vec3(0, 0, 3)}));
    // A light behind the floor is hidden by it.
    EXPECT_TRUE(scene.occluded(end(2, {0, 0, 4}), SegmentEnd{Vec3(1.5F, 0, -1)}));
    EXPECT_FALSE(scene.occluded(SegmentEnd{Vec3(1, 1, 1)}, SegmentEnd{Vec3(1, 1, 1)}));
}

TEST(Scene, MayBeEmpty) {
    const Scene scene{SceneDesc{}};
    EXPECT_FALSE(scene.intersect({}));
    EXPECT_FALSE(scene.occluded_along({Vec3::Zero()}, Vec3::UnitX()));
    EXPECT_TRUE(scene.casters().empty() && scene.lights().empty());
}

}  // namespace
}  // namespace caustics

#include "core/scene/lights_on_casters.h"

#include <gtest/gtest.h>

#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

std::vector<LightOnCaster> found(std::vector<Shape> shapes, const Vec3d& light) {
    SceneDesc desc;
    desc.shapes = std::move(shapes);
    desc.lights = {support::point_light(light, 1)};
    return lights_on_casters(Scene(std::move(desc)));
}

Shape mirror() { return support::horizontal("mirror", 2, 3, false, support::mirror()); }
Shape floor() { return support::horizontal("floor", 0, 5, true, support::diffuse(0.5F)); }

Shape mesh_ball() {
    return support::mesh("mesh", tessellate_sphere(64),
                         Transform(Eigen::Translation3d(0.7, 0.2, 2)), support::glass(1.5F));
}

TEST(LightsOnCasters, AreFoundOnFlatAndCurvedSurfacesAndMeshes) {
    const auto on_mirror = found({floor(), mirror()}, {0.013, 0.021, 2});
    ASSERT_EQ(on_mirror.size(), 1U);
    EXPECT_EQ(on_mirror[0].caster, 1U);
    EXPECT_EQ(on_mirror[0].position, Vec3(0.013F, 0.021F, 2));
    const Vec3d towards = Vec3d(0.3, -0.5, 0.8).normalized();
    EXPECT_EQ(found({floor(), support::sphere("ball", {0, 0, 2}, 1, support::glass(1.5F))},
                    Vec3d(0, 0, 2) + towards)
                  .size(),
              1U);
    const Shape ball = mesh_ball();
    const auto& [a, b, c] = ball.mesh.triangles[1000];
    const auto& at = ball.mesh.positions;
    EXPECT_EQ(found({floor(), ball}, ((at[a] + at[b] + at[c]) / 3).cast<double>()).size(), 1U);
    // A corner of many triangles, and one under a floor that lies on it.
    EXPECT_EQ(found({floor(), ball}, at[a].cast<double>()).size(), 1U);
    EXPECT_EQ(found({mirror(), support::horizontal("plate", 2, 1, true, support::diffuse(0.5F))},
                    {0.1, 0.2, 2})
                  .size(),
              1U);
}

TEST(LightsOnCasters, AreNotThoseBesideThemNorOnReceivers) {
    for (const double off : {1e-6, -1e-6, 1e-3})
        EXPECT_TRUE(found({floor(), mirror()}, {0.013, 0.021, 2 + off}).empty()) << off;
    EXPECT_TRUE(found({floor(), mirror()}, {0.013, 0.021, 0}).empty());
    EXPECT_TRUE(found({floor(), mirror()}, {3.1, 0, 2}).empty());
}

TEST(LightsOnCasters, MayBeAreaLightsThatLieOnOne) {
    for (const double height : {2.0, 1.99}) {
        SceneDesc desc;
        desc.shapes = {mirror(),
                       support::horizontal("lamp", height, 0.2, false, support::diffuse(0))};
        desc.shapes.back().radiance = Spectrum::Constant(2);
        EXPECT_EQ(lights_on_casters(Scene(std::move(desc))).size(), height == 2.0 ? 1U : 0U);
    }
}

TEST(LightsOnCasters, AreNotLampsThatMirrorThemselves) {
    SceneDesc desc;
    desc.shapes = {floor(), mirror()};
    desc.shapes.back().radiance = Spectrum::Constant(2);
    EXPECT_TRUE(lights_on_casters(Scene(std::move(desc))).empty());
}

}  // namespace
}  // namespace caustics

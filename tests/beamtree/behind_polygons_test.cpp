#include "beamtree/beams/behind_polygons.h"

#include <gtest/gtest.h>

#include "tests/support/build_scene.h"

namespace caustics::beamtree {
namespace {

constexpr double radius = 0.5;

// A ball of glass within a ball of glass, seen by polygons of both.
std::vector<WallsBehind> walls_of(double inner_radius, int resolution) {
    SceneDesc desc;
    desc.shapes = {support::sphere("outer", {0, 0, 0}, radius, support::glass(1.5F)),
                   support::sphere("inner", {0, 0, 0}, inner_radius, support::glass(1.333F))};
    const Scene scene(std::move(desc));
    std::vector<WallsBehind> walls;
    for (const CasterMesh& caster : caster_meshes(scene, resolution))
        walls.push_back(walls_behind_polygons(scene, caster));
    return walls;
}

// Edges across cells lie below the sphere by up to about radius (pi / resolution)^2 / 4: 0.3 mm of 64 cells.
TEST(WallsBehindPolygons, AreThoseThinnerThanPolygonsAreFlat) {
    const auto thin = walls_of(radius - 1e-4, 64);
    EXPECT_GT(thin[0].share, 0.9);
    EXPECT_EQ(thin[1].share, 0) << "nothing lies between the inner ball and its polygons";
    const auto thick = walls_of(radius - 5e-3, 64);
    EXPECT_EQ(thick[0].share, 0);
    EXPECT_EQ(thick[1].share, 0);
}

TEST(WallsBehindPolygons, AreNoneOnceTheyAreAsFineAsIsSaid) {
    const auto thin = walls_of(radius - 1e-3, 16);
    ASSERT_GT(thin[0].share, 0.9);
    EXPECT_GT(thin[0].finer, 2);
    EXPECT_LT(thin[0].finer, 10);
    EXPECT_EQ(walls_of(radius - 1e-3, static_cast<int>(16 * thin[0].finer) + 1)[0].share, 0);
}

}  // namespace
}  // namespace caustics::beamtree

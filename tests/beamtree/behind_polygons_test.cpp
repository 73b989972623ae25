#include "beamtree/beams/behind_polygons.h"

#include <gtest/gtest.h>

#include <string>

#include "beamtree/beam_tree.h"
#include "core/base/error.h"
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

constexpr int coarse = 16;

// What is said, by polygons so fine, of a lamp within a ball of glass: on the way out through the middle of a coarse polygon, at
// its height in the bulge above, 1 at the sphere; empty where it is served.
std::string said_of_lamp(double height, int resolution) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0}, radius, support::glass(1.5F))};
    const std::vector<CasterMesh> casters = caster_meshes(Scene(desc), coarse);
    const TriangleMesh& mesh = casters[0].mesh;
    Vec3d middle = Vec3d::Zero();
    for (const std::uint32_t corner : mesh.triangles[mesh.triangles.size() / 2])
        middle += mesh.positions[corner].cast<double>() / 3;
    const double bulge = radius - middle.norm();
    desc.lights = {support::point_light(middle.normalized() * (middle.norm() + height * bulge), 1)};
    BeamTreeParams params;
    params.mesh_resolution = resolution;
    params.max_bounces = 1;
    try {
        build(Scene(desc), params, {});
    } catch (const UnsupportedScene& refusal) {
        return refusal.what();
    }
    return "";
}

TEST(LightBehindPolygons, IsRefusedUntilTheyAreAsFineAsIsSaid) {
    EXPECT_EQ(said_of_lamp(-1, coarse), "") << "on the same side of polygon and surface";
    const std::string said = said_of_lamp(0.5, coarse);
    const std::string before = "take a mesh_resolution ";
    const std::size_t place = said.find(before);
    ASSERT_NE(place, std::string::npos) << said;
    const int finer = std::stoi(said.substr(place + before.size()));
    EXPECT_GE(finer, 2);
    EXPECT_LE(finer, 4) << "a bulge falls with the square of the polygons' size";
    EXPECT_EQ(said_of_lamp(0.5, coarse * finer), "");
}

}  // namespace
}  // namespace caustics::beamtree

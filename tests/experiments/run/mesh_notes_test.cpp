#include "experiments/run/mesh_notes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics::experiments {
namespace {

const Transform in_the_middle(Eigen::Translation3d(0, 0, 1) * Eigen::Scaling(0.2));

/// A mesh of a file over a floor, under a lamp, before a camera.
SceneDesc scene_of_mesh(TriangleMesh mesh, const Bsdf& bsdf,
                        const Transform& place = in_the_middle) {
    SceneDesc desc;
    desc.shapes = {support::mesh("it", std::move(mesh), place, bsdf),
                   support::horizontal("floor", 0, 2, true, support::diffuse(0.5F))};
    desc.shapes[0].is_of_file = true;
    desc.lights = {support::point_light({0, 0, 4}, 1)};
    desc.camera = support::camera({0, -4, 2}, {0, 0, 1}, {0, 0, 1}, 40, 64, 48);
    return desc;
}

std::vector<std::string> all_mesh_notes(const SceneDesc& desc) { return mesh_notes(Scene(desc)); }

/// The only note; empty where there is none.
std::string mesh_note(const SceneDesc& desc) {
    const std::vector<std::string> all = all_mesh_notes(desc);
    EXPECT_LE(all.size(), 1U);
    return all.empty() ? "" : all[0];
}

bool has_words(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
}

TriangleMesh cube_with_turned_faces() {
    TriangleMesh cube = tessellate_cube(1);
    cube.normals.clear();
    for (const std::size_t t : {0U, 1U, 4U, 5U, 8U})
        std::swap(cube.triangles[t][1], cube.triangles[t][2]);
    return cube;
}

TriangleMesh flipped_cube() {
    TriangleMesh cube = tessellate_cube(1);
    flip(cube);
    return cube;
}

TEST(MeshNotes, CountTurnedFacesWhereTheyChangeLight) {
    SceneDesc desc = scene_of_mesh(cube_with_turned_faces(), support::glass(1.5F));
    const std::string note = mesh_note(desc);
    EXPECT_TRUE(has_words(note, "mesh it: 5 of 12 triangles face the wrong way")) << note;
    EXPECT_TRUE(has_words(note, "\"orient\": true turns them")) << note;
    desc.shapes[0].bsdf = support::diffuse(0.5F);
    desc.shapes[0].bsdf.twosided = false;
    EXPECT_TRUE(has_words(mesh_note(desc), "black"));
    desc.shapes[0].bsdf = support::mirror();
    desc.shapes[0].bsdf.twosided = true;
    EXPECT_EQ(all_mesh_notes(desc), std::vector<std::string>{});
    EXPECT_EQ(mesh_note(scene_of_mesh(tessellate_cube(1), support::glass(1.5F))), "");
}

TEST(MeshNotes, NameThePartsThatAreInsideOut) {
    SceneDesc desc = scene_of_mesh(flipped_cube(), support::glass(1.5F));
    EXPECT_TRUE(has_words(mesh_note(desc), "1 of 1 part inside out (12 triangles face inwards)"));
    // A cavity in other glass, and a bubble of thinner stuff.
    desc.shapes.push_back(support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1.5F)));
    EXPECT_EQ(mesh_note(desc), "");
    desc.shapes.pop_back();
    desc.shapes[0].bsdf = support::glass(1, 1.5F);
    EXPECT_EQ(mesh_note(desc), "");
    // A room round the camera.
    desc = scene_of_mesh(flipped_cube(), support::diffuse(0.5F), Transform(Eigen::Scaling(9.0)));
    desc.shapes[0].bsdf.twosided = false;
    EXPECT_EQ(mesh_note(desc), "");
}

TEST(MeshNotes, TellHolesOfGlassFromTheBordersOfWater) {
    TriangleMesh cube = tessellate_cube(2);
    cube.triangles.pop_back();
    EXPECT_TRUE(has_words(mesh_note(scene_of_mesh(cube, support::glass(1.5F))),
                          "closed but for holes (1 hole with 3 open edges in all)"));
    EXPECT_EQ(mesh_note(scene_of_mesh(cube, support::mirror())), "");
    EXPECT_EQ(mesh_note(scene_of_mesh(tessellate_rectangle({3, 3}), support::glass(1.33F))), "");
}

TEST(MeshNotes, SayWhatOrientCouldNotTell) {
    SceneDesc desc = scene_of_mesh(tessellate_rectangle({3, 3}), support::glass(1.33F));
    desc.shapes[0].is_oriented = true;
    EXPECT_TRUE(has_words(mesh_note(desc), "the outside of 1 of 1 part cannot be told"));
    desc = scene_of_mesh(tessellate_cube(1), support::glass(1.33F));
    desc.shapes[0].is_oriented = true;
    EXPECT_EQ(mesh_note(desc), "");
}

TEST(MeshNotes, NameAFileOfAnotherUnit) {
    const Transform huge(Eigen::Translation3d(0, 0, 900) * Eigen::Scaling(800.0));
    EXPECT_TRUE(has_words(mesh_note(scene_of_mesh(tessellate_cube(1), support::glass(1.5F), huge)),
                          "if its file has millimetres and the scene metres"));
    const Transform tiny(Eigen::Translation3d(0, 0, 1) * Eigen::Scaling(1e-4));
    EXPECT_TRUE(has_words(mesh_note(scene_of_mesh(tessellate_cube(1), support::glass(1.5F), tiny)),
                          "if its file has metres and the scene millimetres"));
}

TEST(MeshNotes, ListPartsAndFlaws) {
    EXPECT_EQ(listed(diagnose(tessellate_cube(1))), "");
    EXPECT_EQ(listed(diagnose(cube_with_turned_faces())),
              ", 5 triangles turned against their neighbours");
    EXPECT_EQ(listed(diagnose(flipped_cube())), ", faces inwards (right for a cavity only)");
    EXPECT_EQ(listed(diagnose(tessellate_rectangle({3, 2}))), ", 10 open edges along 1 border");
}

}  // namespace
}  // namespace caustics::experiments

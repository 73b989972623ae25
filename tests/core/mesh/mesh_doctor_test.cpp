#include "core/mesh/mesh_doctor.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "core/mesh/vertex_normals.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics {
namespace {

void turn(TriangleMesh& mesh, std::size_t triangle) {
    std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
}

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by, double scale = 1) {
    transform(mesh, Transform(Eigen::Translation3d(by) * Eigen::Scaling(scale)));
    return mesh;
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
    mesh.uvs.clear();
    for (const auto& [a, b, c] : more.triangles)
        mesh.triangles.push_back({a + first, b + first, c + first});
    return mesh;
}

TriangleMesh flipped(TriangleMesh mesh) {
    flip(mesh);
    return mesh;
}

std::size_t count(const std::vector<bool>& turned) {
    return static_cast<std::size_t>(std::count(turned.begin(), turned.end(), true));
}

TEST(MeshDoctor, FindsNothingWrongWithClosedMeshes) {
    for (const TriangleMesh& mesh :
         {tessellate_sphere(8), tessellate_cube(3), moved(tessellate_cube(2), {1000, 0, 0})}) {
        const MeshDiagnosis found = diagnose(mesh);
        EXPECT_EQ(found.parts, 1U);
        EXPECT_EQ(found.closed_parts, 1U);
        EXPECT_EQ(found.open_edges + found.crowded_edges + found.duplicates, 0U);
        EXPECT_EQ(count(found.turned), 0U);
    }
    EXPECT_EQ(diagnose({}).parts, 0U);
}

// A turned face is no hole: it was told as six open edges.
TEST(MeshDoctor, TellsTurnedFacesFromHoles) {
    TriangleMesh cube = tessellate_cube(1);
    for (const std::size_t t : {0U, 1U, 4U, 5U, 9U}) turn(cube, t);
    const MeshDiagnosis turned = diagnose(cube);
    EXPECT_EQ(turned.open_edges, 0U);
    EXPECT_EQ(turned.closed_parts, 1U);
    EXPECT_EQ(turned.mixed_parts, 1U);
    EXPECT_EQ(turned.turned_triangles, 5U);
    for (const std::size_t t : {0U, 1U, 4U, 5U, 9U}) EXPECT_TRUE(turned.turned[t]);
    cube = tessellate_cube(1);
    cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 2);
    const MeshDiagnosis holed = diagnose(cube);
    EXPECT_EQ(holed.open_edges, 4U);
    EXPECT_EQ(holed.holes, 1U);
    EXPECT_EQ(holed.hollow_parts, 1U);
    EXPECT_EQ(holed.closed_parts, 0U);
    EXPECT_EQ(count(holed.turned), 0U);
}

TEST(MeshDoctor, TellsSheetsFromHollowParts) {
    const MeshDiagnosis sheet = diagnose(tessellate_rectangle({3, 2}));
    EXPECT_EQ(sheet.open_edges, 10U);
    EXPECT_EQ(sheet.holes, 1U);
    EXPECT_EQ(sheet.hollow_parts, 0U);
    const MeshDiagnosis pipe = diagnose(tessellate_cylinder(4));
    EXPECT_EQ(pipe.open_edges, 32U);
    EXPECT_EQ(pipe.holes, 2U);
    EXPECT_EQ(pipe.hollow_parts, 1U);
}

TEST(MeshDoctor, CountsPartsThatAreInsideOut) {
    const TriangleMesh cube = tessellate_cube(1);
    const MeshDiagnosis one = diagnose(flipped(cube));
    EXPECT_EQ(one.inside_out_parts, 1U);
    EXPECT_EQ(one.inside_out_triangles, 12U);
    EXPECT_EQ(one.mixed_parts, 0U);
    const MeshDiagnosis two = diagnose(joined(cube, moved(flipped(cube), {5, 0, 0})));
    EXPECT_EQ(two.parts, 2U);
    EXPECT_EQ(two.closed_parts, 2U);
    EXPECT_EQ(two.inside_out_parts, 1U);
    EXPECT_EQ(two.inside_out_triangles, 12U);
    EXPECT_EQ(count(two.turned), 12U);
}

TEST(MeshDoctor, PartsInsideOthersAreCavities) {
    const TriangleMesh cube = tessellate_cube(1);
    const TriangleMesh inner = moved(cube, {0.1, 0, 0}, 0.5);
    const TriangleMesh core = moved(cube, {0.1, 0, 0}, 0.2);
    const MeshDiagnosis hollow = diagnose(joined(cube, flipped(inner)));
    EXPECT_EQ(hollow.cavities, 1U);
    EXPECT_EQ(count(hollow.turned), 0U);
    const MeshDiagnosis solid = diagnose(joined(cube, inner));
    EXPECT_EQ(solid.outward_cavities, 1U);
    EXPECT_EQ(count(solid.turned), 12U);
    const MeshDiagnosis three = diagnose(joined(joined(cube, flipped(inner)), core));
    EXPECT_EQ(three.cavities, 1U);
    EXPECT_EQ(count(three.turned), 0U);
    // A part that crosses another one does not lie inside it.
    const MeshDiagnosis crossing = diagnose(joined(cube, moved(inner, {0.9, 0, 0})));
    EXPECT_EQ(crossing.cavities, 0U);
    EXPECT_EQ(count(crossing.turned), 0U);
}

TriangleMesh moebius_strip(std::uint32_t steps) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < steps; ++i) {
        const double angle = 2 * pi_d * i / steps;
        const Vec3d out(std::cos(angle), std::sin(angle), 0);
        const Vec3d across =
            0.3 * (std::cos(angle / 2) * out + std::sin(angle / 2) * Vec3d::UnitZ());
        mesh.positions.emplace_back(Vec3d(out + across).cast<float>());
        mesh.positions.emplace_back(Vec3d(out - across).cast<float>());
    }
    for (std::uint32_t i = 0; i < steps; ++i) {
        const bool last = i + 1 == steps;
        const std::uint32_t a = 2 * i, b = a + 1;
        const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
    }
    return mesh;
}

TEST(MeshDoctor, KnowsAMoebiusStrip) {
    TriangleMesh strip = moebius_strip(40);
    const MeshDiagnosis found = diagnose(strip);
    EXPECT_EQ(found.one_sided_parts, 1U);
    EXPECT_EQ(found.parts_of_no_outside(), 1U);
    EXPECT_THROW(orient(strip), InputError);
}

TEST(MeshDoctor, LeavesOutDuplicatesAndTrianglesWithoutArea) {
    TriangleMesh cube = tessellate_cube(1);
    cube.triangles.push_back(cube.triangles[3]);
    cube.triangles.push_back(cube.triangles[7]);
    turn(cube, cube.triangles.size() - 1);
    cube.triangles.push_back({0, 0, 1});
    const MeshDiagnosis found = diagnose(cube);
    EXPECT_EQ(found.duplicates, 2U);
    EXPECT_EQ(found.without_area, 1U);
    EXPECT_EQ(found.parts, 1U);
    EXPECT_EQ(found.closed_parts, 1U);
    EXPECT_EQ(found.crowded_edges, 0U);
}

TEST(MeshDoctor, CubesThatShareAnEdgeAreTwoClosedParts) {
    const TriangleMesh cube = tessellate_cube(1);
    const MeshDiagnosis found = diagnose(joined(cube, moved(cube, {2, 2, 0})));
    EXPECT_EQ(found.parts, 2U);
    EXPECT_EQ(found.closed_parts, 2U);
    EXPECT_EQ(found.crowded_edges, 1U);
    EXPECT_EQ(found.open_edges, 0U);
}

TEST(MeshDoctor, OrientsWhatWasTurnedAtRandom) {
    Rng rng(7, Stage::test, 0);
    const TriangleMesh ball = tessellate_sphere(10);
    TriangleMesh mesh = joined(joined(ball, flipped(moved(ball, {0.2, 0, 0}, 0.3))),
                               moved(tessellate_cube(2), {4, 0, 0}));
    const double volume = test::volume(mesh);
    const auto triangles = mesh.triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (rng.next() < 0.4F) turn(mesh, t);
    orient(mesh);
    EXPECT_NEAR(test::volume(mesh), volume, 1e-9);
    EXPECT_EQ(count(diagnose(mesh).turned), 0U);
    EXPECT_EQ(test::open_edges(mesh), 0U);
}

TEST(MeshDoctor, OpenPartsKeepTheSideOfMostOfTheirArea) {
    TriangleMesh sheet = tessellate_rectangle({4, 4});
    for (const std::size_t t : {3U, 8U, 9U, 20U}) turn(sheet, t);
    EXPECT_EQ(diagnose(sheet).turned_triangles, 4U);
    orient(sheet);
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
        EXPECT_GT(test::area_vector(sheet, t).z(), 0);
}

TEST(MeshDoctor, NormalsOfTheFileTurnWithTheirTriangles) {
    const TriangleMesh right = tessellate_sphere(6);
    TriangleMesh mesh = flipped(right);
    orient(mesh);
    EXPECT_EQ(mesh.triangles, right.triangles);
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        EXPECT_EQ(mesh.normals[i], right.normals[i]);
    // Normals that were right stay as they are where triangles alone were turned.
    mesh = right;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) turn(mesh, t);
    orient(mesh);
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        EXPECT_EQ(mesh.normals[i], right.normals[i]);
}

}  // namespace
}  // namespace caustics

#include "core/geometry/cut_solid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics {
namespace {

CutSolid box(const Vec3d& half) {
    CutSolid solid;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            solid.planes.push_back({side * Vec3d::Unit(axis), half[axis]});
    return solid;
}

CutSolid octahedron() {
    CutSolid solid;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0})
                solid.planes.push_back({Vec3d(x, y, z).normalized(), 1 / std::sqrt(3)});
    return solid;
}

void add(CutSolid& solid, const CutRing& ring) {
    for (const HalfSpace& plane : half_spaces(ring)) solid.planes.push_back(plane);
}

// A faceted bowl: 16 walls that lean out by 35 degrees, turned by half a facet, and a foot.
CutSolid bowl() {
    CutSolid solid;
    add(solid, {16, -35, 0.05, 0.5});
    solid.planes.push_back({-Vec3d::UnitZ(), 0});
    solid.height = 0.06;
    solid.inner.emplace();
    for (const Vec2d& at : {Vec2d(0.092, 0.06), Vec2d(0.077, 0.039), Vec2d(0.052, 0.018),
                            Vec2d(0.028, 0.009), Vec2d(0, 0.008)})
        solid.inner->points.push_back({at});
    solid.inner_sectors = 48;
    return solid;
}

// What facets of their own normals say; no vertex belongs to two of them.
void expect_flat(const TriangleMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t vertex : mesh.triangles[t])
            EXPECT_GT(
                test::area_vector(mesh, t).normalized().dot(mesh.normals[vertex].cast<double>()),
                1 - 1e-5)
                << t;
}

TEST(CutSolid, OfSixPlanesIsABox) {
    const TriangleMesh mesh = tessellate_cut(box({1, 2, 3}));
    EXPECT_NEAR(test::volume(mesh), 48, 1e-5);
    EXPECT_EQ(test::euler_characteristic(mesh), 2);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_EQ(mesh.positions.size(), 24U);
    expect_flat(mesh);
}

TEST(CutSolid, OfEightPlanesIsAnOctahedron) {
    const TriangleMesh mesh = tessellate_cut(octahedron());
    EXPECT_NEAR(test::volume(mesh), 4.0 / 3, 1e-6);
    EXPECT_EQ(test::euler_characteristic(mesh), 2);
    EXPECT_EQ(mesh.triangles.size(), 8U);
    EXPECT_EQ(test::open_edges(mesh), 0U);
}

TEST(CutSolid, TwoPlanesBoundASlab) {
    CutSolid slab = box({1, 1, 10});
    const Vec3d tilt = Vec3d(0.3, 0.1, 1).normalized();
    slab.planes.push_back({tilt, 0.25});
    slab.planes.push_back({-tilt, -0.2});
    // Across its cut through the box, 4 / cos; nothing else is cut off.
    EXPECT_NEAR(test::volume(tessellate_cut(slab)), 0.05 * 4 / tilt.z(), 1e-6);
}

TEST(CutSolid, IgnoresPlanesThatCutNothingAndTheSameOnceMore) {
    CutSolid solid = box({1, 1, 1});
    solid.planes.push_back({Vec3d(1, 1, 1).normalized(), 1.8});
    solid.planes.push_back({Vec3d::UnitX(), 1});
    EXPECT_EQ(tessellate_cut(solid).triangles.size(), 12U);
}

// A brilliant of 57 facets: many planes through one corner, none of the mesh's edges open.
TEST(CutSolid, OfRingsIsClosed) {
    CutSolid gem;
    add(gem, {8, 55.5, 0.75, 0});
    add(gem, {16, 48, 0.79, 0.5});
    add(gem, {8, 68, 0.7, 0.5});
    add(gem, {16, -47, 0.72, 0.5});
    add(gem, {8, -49.25, 0.71, 0});
    gem.height = 0.7;
    const TriangleMesh mesh = tessellate_cut(gem);
    EXPECT_EQ(test::open_edges(mesh), 0U);
    EXPECT_EQ(test::euler_characteristic(mesh), 2);
    EXPECT_GT(test::volume(mesh), 1);
    expect_flat(mesh);
}

TEST(CutSolid, OfACutBowlIsOneClosedVolume) {
    const CutSolid cut = bowl();
    const TriangleMesh mesh = tessellate_cut(cut);
    EXPECT_EQ(test::open_edges(mesh), 0U);
    EXPECT_EQ(test::euler_characteristic(mesh), 2);
    CutSolid full = cut;
    full.inner.reset();
    LatheProfile hollow = *cut.inner;
    hollow.points.insert(hollow.points.begin(), {{0, 0.06}});
    const double inside = -test::volume(tessellate_lathe(hollow, cut.inner_sectors));
    EXPECT_GT(inside, 0);
    EXPECT_NEAR(test::volume(mesh), test::volume(tessellate_cut(full)) - inside, 1e-9);
    ASSERT_EQ(mesh.patches.size(), 2U);
    EXPECT_EQ(mesh.patches[0].columns, 48U);
    EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
}

TEST(CutSolid, RimsOfAnyTwoCountsAreClosedAndFaceUp) {
    for (const int facets : {3, 4, 7, 40})
        for (const int sectors : {3, 5, 16, 64}) {
            CutSolid solid;
            add(solid, {facets, 10, 1, 0.3});
            solid.planes.push_back({-Vec3d::UnitZ(), 1});
            solid.height = 0.5;
            solid.inner.emplace();
            solid.inner->points = {{{0, 0}}, {{0.9, 0.5}}};
            solid.inner_sectors = sectors;
            const TriangleMesh mesh = tessellate_cut(solid);
            EXPECT_EQ(test::open_edges(mesh), 0U) << facets << ' ' << sectors;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                for (const std::uint32_t vertex : mesh.triangles[t])
                    EXPECT_GT(test::area_vector(mesh, t).dot(mesh.normals[vertex].cast<double>()),
                              0)
                        << facets << ' ' << sectors << ' ' << t;
        }
}

std::string refusal(const CutSolid& bad) {
    try {
        tessellate_cut(bad);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(CutSolid, RefusesWhatEnclosesNothing) {
    CutSolid none;
    EXPECT_NE(refusal(none).find("leave the solid open"), std::string::npos);
    CutSolid open = box({1, 1, 1});
    open.planes.pop_back();
    EXPECT_NE(refusal(open).find("open towards"), std::string::npos) << refusal(open);
    CutSolid empty = box({1, 1, 1});
    empty.planes.push_back({Vec3d::UnitX(), -2});
    EXPECT_NE(refusal(empty).find("enclose nothing"), std::string::npos) << refusal(empty);
    CutSolid flat = box({1, 1, 0});
    EXPECT_NE(refusal(flat).find("enclose nothing"), std::string::npos) << refusal(flat);
    CutSolid many = box({1, 1, 1});
    add(many, {195, 0, 1, 0});
    EXPECT_NE(refusal(many).find("201 planes"), std::string::npos) << refusal(many);
    CutSolid low = box({1, 1, 1});
    low.height = 2;
    EXPECT_NE(refusal(low).find("cuts nothing off"), std::string::npos) << refusal(low);
}

TEST(CutSolid, RefusesAnInsideThatDoesNotFit) {
    CutSolid wide = bowl();
    wide.inner->points[1].at.x() = 0.09;
    EXPECT_NE(refusal(wide).find("reaches the outside"), std::string::npos) << refusal(wide);
    CutSolid short_of = bowl();
    short_of.inner->points[0].at.y() = 0.05;
    EXPECT_NE(refusal(short_of).find("the rim, z = 0.06"), std::string::npos);
    CutSolid holed = bowl();
    holed.inner->points.pop_back();
    EXPECT_NE(refusal(holed).find("must end on the axis"), std::string::npos);
    CutSolid topless = bowl();
    topless.height.reset();
    EXPECT_NE(refusal(topless).find("needs the height"), std::string::npos);
}

}  // namespace
}  // namespace caustics

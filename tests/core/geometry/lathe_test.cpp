#include "core/geometry/lathe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "core/mesh/mesh_rows.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics {
namespace {

LatheProfile profile(const std::vector<Vec2d>& points) {
    LatheProfile made;
    for (const Vec2d& at : points) made.points.push_back({at});
    return made;
}

// From the south pole to the north, which are met exactly.
LatheProfile semicircle(int spans) {
    LatheProfile made;
    for (int i = 0; i <= spans; ++i) {
        const double angle = pi_d * i / spans;
        const bool pole = i == 0 || i == spans;
        made.points.push_back({{pole ? 0 : std::sin(angle), -std::cos(angle)}});
    }
    return made;
}

// A tube's section: Pappus gives 2 pi R times its area, pi r^2.
LatheProfile circle(double distance, double radius, int points) {
    LatheProfile made;
    for (int i = 0; i <= points; ++i) {
        const double angle = 2 * pi_d * (i % points) / points;
        made.points.push_back({{distance + radius * std::cos(angle), radius * std::sin(angle)}});
    }
    return made;
}

TEST(Lathe, OfASemicircleIsTheSphere) {
    const TriangleMesh sphere = tessellate_sphere(8);
    const TriangleMesh lathe = tessellate_lathe(semicircle(8), 16);
    ASSERT_EQ(lathe.positions.size(), sphere.positions.size());
    EXPECT_EQ(lathe.triangles, sphere.triangles);
    for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
        EXPECT_LT((lathe.positions[i] - sphere.positions[i]).norm(), 1e-6F) << i;
        EXPECT_LT((lathe.normals[i] - sphere.normals[i]).norm(), 1e-6F) << i;
    }
    ASSERT_EQ(lathe.patches.size(), sphere.patches.size());
    EXPECT_EQ(lathe.patches[1].rows, 6U);
    EXPECT_EQ(lathe.patches[1].columns, 16U);
}

TEST(Lathe, VolumeConvergesToPappusAtSecondOrder) {
    const double truth = 2 * pi_d * 3 * pi_d;
    const auto error = [&](int n) {
        return truth - test::volume(tessellate_lathe(circle(3, 1, n), n));
    };
    EXPECT_NEAR(error(32) / error(64), 4, 0.1);
    const TriangleMesh torus = tessellate_lathe(circle(3, 1, 16), 32);
    EXPECT_EQ(test::open_edges(torus), 0U);
    EXPECT_EQ(test::euler_characteristic(torus), 0);
}

TEST(Lathe, CurvesComeNearerToTheCircleThanLinesAndKeepItsNormals) {
    LatheProfile curve = semicircle(6);
    curve.catmull_rom = true;
    curve.segments = 16;
    const TriangleMesh mesh = tessellate_lathe(curve, 64);
    EXPECT_EQ(test::open_edges(mesh), 0U);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(mesh.positions[i].norm(), 1, 0.005);
        EXPECT_GT(mesh.positions[i].normalized().dot(mesh.normals[i]), 0.9995F);
    }
}

TEST(Lathe, CreasesSplitNormals) {
    // A can: floor, wall and lid.
    LatheProfile can = profile({{0, 0}, {1, 0}, {1, 2}, {0, 2}});
    can.points[1].crease = can.points[2].crease = true;
    const TriangleMesh mesh = tessellate_lathe(can, 12);
    EXPECT_EQ(test::open_edges(mesh), 0U);
    EXPECT_LT(largest_bend(mesh), 2 * pi_d / 12);
    EXPECT_EQ(mesh.normals[0], Vec3(0, 0, -1));
    EXPECT_EQ(mesh.normals[13], Vec3(1, 0, 0));
    can.points[1].crease = can.points[2].crease = false;
    EXPECT_GT(largest_bend(tessellate_lathe(can, 12)), pi_d / 5);
}

// The largest angle between a triangle's normal and that of its corners, of a cone that may have a crease on the axis.
double bend_of_cone(double slope, bool crease, int lines) {
    LatheProfile cone;
    for (int i = 0; i <= lines; ++i)
        cone.points.push_back({{fraction(i, lines), slope * fraction(i, lines)}});
    cone.points.front().crease = crease;
    cone.points.back().crease = true;
    cone.points.push_back({{0, slope}});
    return largest_bend(tessellate_lathe(cone, 256));
}

TEST(Lathe, TipsOfConesAreCreases) {
    for (const double slope : {-2.0, -0.2, 0.01, 0.2, 1.0, 5.0})
        for (const int lines : {1, 2, 5})
            for (const bool crease : {false, true})
                EXPECT_LT(bend_of_cone(slope, crease, lines), pi_d / 256 + 1e-6)
                    << slope << " " << lines << " " << crease;
}

// The caps of lenses, of as few straight lines as it may be, are no cones.
TEST(Lathe, PolesOfSmoothCapsStaySmooth) {
    for (const int spans : {4, 9, 40}) {
        const TriangleMesh sphere = tessellate_lathe(semicircle(spans), 12);
        EXPECT_NEAR(sphere.normals.back().z(), 1, 1e-6) << spans;
    }
    LatheProfile dish;
    for (int i = 0; i <= 8; ++i) dish.points.push_back({{0.1 * i, 0.04 * i * i}});
    dish.open = true;
    for (const Vec3& n : tessellate_lathe(dish, 12).normals)
        if (n.z() < -0.9999F) return;
    FAIL() << "no normal along the axis";
}

TEST(Lathe, CurvesAreMirroredByTheAxisUnlessTheirPoleIsACrease) {
    LatheProfile curve = profile({{0, 0}, {0.5, 0.5}, {1, 1}});
    curve.open = curve.catmull_rom = true;
    curve.segments = 64;
    const auto lean = [&] { return std::abs(tessellate_lathe(curve, 16).normals.back().z()); };
    curve.points = {curve.points.rbegin(), curve.points.rend()};
    EXPECT_NEAR(lean(), 1, 1e-6);
    curve.points.back().crease = true;
    EXPECT_NEAR(lean(), std::sqrt(0.5), 1e-6);
}

TEST(Lathe, WindsTrianglesAroundTheirNormalsAndHasOneCellPatch) {
    LatheProfile vase = profile({{0, 0}, {0.5, 0.1}, {0.8, 0.6}, {0.3, 1.5}, {0.4, 2}});
    vase.open = true;
    vase.points[2].crease = true;
    vase.segments = 3;
    for (const bool curved : {false, true}) {
        vase.catmull_rom = curved;
        const TriangleMesh mesh = tessellate_lathe(vase, 20);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (const std::uint32_t vertex : mesh.triangles[t])
                EXPECT_GT(test::area_vector(mesh, t).normalized().dot(
                              mesh.normals[vertex].cast<double>()),
                          0.5)
                    << t;
        ASSERT_EQ(mesh.patches.size(), 2U);
        EXPECT_EQ(mesh.patches[1].columns * mesh.patches[1].rows * 2 + 20, mesh.triangles.size());
        EXPECT_EQ(test::open_edges(mesh), 20U);
    }
}

// Glass, its water and the film between them: rings at the same (r, z) have the same bits.
TEST(Lathe, PartsShareTheirRings) {
    const Vec2d low(0.0312345, 0.01);
    const Vec2d high(0.0498765, 0.0734567);
    LatheProfile parts[] = {profile({{0, 0}, {0.06, 0}, {0.061, 0.1}, high, low, {0, 0.005}}),
                            profile({{0, 0.004}, low, high, {0, high.y()}}), profile({low, high})};
    std::vector<std::set<std::array<float, 3>>> places;
    for (LatheProfile& part : parts) {
        part.open = true;
        places.emplace_back();
        for (const Vec3& p : tessellate_lathe(part, 48).positions)
            places.back().insert({p.x(), p.y(), p.z()});
    }
    EXPECT_EQ(places[2].size(), 96U);
    for (const auto& place : places[2]) {
        EXPECT_TRUE(places[0].contains(place));
        EXPECT_TRUE(places[1].contains(place));
    }
}

std::string refusal_of(const LatheProfile& bad, int sectors = 8) {
    try {
        tessellate_lathe(bad, sectors);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Lathe, RefusesProfilesThatMakeNoSurface) {
    const std::vector<std::pair<std::vector<Vec2d>, std::string>> bad = {
        {{{1, 0}}, "at least 2 points"},
        {{{0, 0}, {-1, 1}, {0, 2}}, "point 1 [-1, 1] lies across the axis"},
        {{{0, 0}, {1, 1}, {1, 1}, {0, 2}}, "points 1 and 2 coincide"},
        {{{0, 0}, {1, 1}, {0, 2}, {1, 3}, {0, 4}}, "point 2 [0, 2] is on the axis"},
        {{{0, 0}, {0, 1}}, "along the axis"},
        {{{0, 0}, {1, 1}, {1, -1}, {0, 0}}, "one point of the axis"},
        {{{0, 0}, {1, 1}}, "last end [1, 1] is off the axis"},
        {{{1, 0}, {0, 1}}, "first end [1, 0] is off the axis"},
        {{{0, 0}, {2, 2}, {2, 0}, {0, 2}},
         "meets itself near [2, 0]: between points 0 and 1, "
         "and between points 2 and 3"},
        {{{0, 0}, {2, 0}, {1, 0}, {0, 2}}, "meets itself"}};
    for (const auto& [points, reason] : bad) {
        const std::string message = refusal_of(profile(points));
        EXPECT_NE(message.find(reason), std::string::npos) << message;
    }
    EXPECT_NE(refusal_of(semicircle(8), 2).find("2 sectors"), std::string::npos);
    EXPECT_NE(refusal_of(semicircle(5000)).find("more than 4096 segments"), std::string::npos);
    // A curve swings over the axis where its points do not.
    LatheProfile curve = profile({{1, 0}, {0.01, 0.01}, {0.01, 1}, {1, 1.01}});
    curve.open = true;
    EXPECT_EQ(refusal_of(curve), "accepted");
    curve.catmull_rom = true;
    curve.segments = 8;
    EXPECT_NE(refusal_of(curve).find("the curve crosses the axis"), std::string::npos);
}

}  // namespace
}  // namespace caustics

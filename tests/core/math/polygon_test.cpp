#include "core/math/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace caustics {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Vec3d area_vector(const std::vector<Vec3d>& corners) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i)
        sum += corners[i].cross(corners[(i + 1) % corners.size()]);
    return sum / 2;
}

/// As many triangles as there must be; each on the polygon's side, and their areas add up to the
/// polygon's: then they neither overlap nor leave a gap.
void expect_partition(const std::vector<Vec3d>& corners) {
    const Triangles triangles = triangulate_polygon(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    const Vec3d whole = area_vector(corners);
    const Vec3d normal = whole.normalized();
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
        const double area = area_vector({corners[a], corners[b], corners[c]}).dot(normal);
        EXPECT_GE(area, -1e-6 * whole.norm());
        sum += std::abs(area);
    }
    EXPECT_NEAR(sum, whole.norm(), 1e-5 * whole.norm());
}

std::vector<Vec3d> star(int corners, double inner) {
    std::vector<Vec3d> polygon;
    for (int i = 0; i < corners; ++i) {
        const double radius = i % 2 == 0 ? 1 : inner, angle = 2 * pi_d * i / corners;
        polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return polygon;
}

TEST(Polygon, AConvexOneIsAFanAboutItsFirstCorner) {
    EXPECT_EQ(triangulate_polygon(star(3, 1)), (Triangles{{0, 1, 2}}));
    EXPECT_EQ(triangulate_polygon(star(5, 1)), (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygon, ManyCornersConvexAndConcaveInAnyPlane) {
    for (const int corners : {4, 6, 10, 100, 1000})
        for (const double inner : {1.0, 0.9, 0.4}) {
            std::vector<Vec3d> polygon = star(corners, inner);
            expect_partition(polygon);
            const Eigen::Matrix3d turned =
                Eigen::AngleAxisd(2.1, Vec3d(1, 2, -1).normalized()).toRotationMatrix();
            for (Vec3d& corner : polygon) corner = turned * corner + Vec3d(5, -2, 1);
            expect_partition(polygon);
            std::ranges::reverse(polygon);
            expect_partition(polygon);
        }
}

TEST(Polygon, AComb) {
    std::vector<Vec3d> comb;
    for (int tooth = 0; tooth < 40; ++tooth) {
        comb.emplace_back(tooth, 0.1, 0);
        comb.emplace_back(tooth + 0.5, 5, 0);
    }
    comb.emplace_back(40, -1, 0);
    comb.emplace_back(0, -1, 0);
    expect_partition(comb);
    std::ranges::reverse(comb);
    expect_partition(comb);
}

TEST(Polygon, CornersOnALineAndTwiceInOnePlace) {
    expect_partition(
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
    expect_partition({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 2, 0}});
    // A keyhole: the outline goes in to a square hole and back along the same line.
    expect_partition({{0, 0, 0},
                      {4, 0, 0},
                      {4, 4, 0},
                      {0, 4, 0},
                      {0, 0, 0},
                      {1, 1, 0},
                      {1, 3, 0},
                      {3, 3, 0},
                      {3, 1, 0},
                      {1, 1, 0}});
}

TEST(Polygon, WhatHasNoAreaStillGivesItsTriangles) {
    EXPECT_EQ(triangulate_polygon(std::vector<Vec3d>(7, Vec3d(1, 2, 3))).size(), 5U);
    EXPECT_EQ(triangulate_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size(), 2U);
    EXPECT_EQ(triangulate_polygon({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2U)
        << "crosses itself";
}

TEST(Polygon, WhatWouldTakeVeryLongIsRefused) {
    EXPECT_EQ(triangulate_polygon(star(4000, 1)).size(), 3998U);
    expect_partition(star(1000, 0.5));
    std::vector<Vec3d> tangle;
    for (int i = 0; i < 20'000; ++i) tangle.emplace_back(i * 7919 % 20'011, i * 6997 % 19'997, 0);
    EXPECT_THROW(triangulate_polygon(tangle), InputError);
}

// Corners that turn right count as work, too: 30,000 such loops, 1 MB, took 16 s; these few would pass uncounted.
TEST(Polygon, LoopsThatTurnTheOtherWayCountAsWork) {
    std::vector<Vec3d> loops = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    for (int i = 0; i < 3000; ++i)
        loops.insert(loops.end(), {{5, 5, 0}, {5, 5.001, 0}, {5.001, 5, 0}});
    EXPECT_THROW(triangulate_polygon(loops), InputError);
}

}  // namespace
}  // namespace caustics

#include "beamtree/cones/cap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "beamtree/cones/neck.h"
#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

std::vector<Vec3d> random_directions(std::size_t count, double spread, Rng& rng) {
    std::vector<Vec3d> directions;
    const Vec3d axis = Vec3d(0.3, -0.5, 0.8).normalized();
    while (directions.size() < count) {
        const Vec3d off =
            Vec3(rng.next(), rng.next(), rng.next()).cast<double>() * 2 - Vec3d::Ones();
        directions.push_back((axis + spread * off).normalized());
    }
    return directions;
}

// The smallest cap is through two or three of the points: try them all.
double smallest_angle_by_force(const std::vector<Vec3d>& u) {
    double best = 4;
    const auto try_axis = [&](const Vec3d& axis) {
        double widest = 0;
        for (const Vec3d& d : u) widest = std::max(widest, std::acos(std::min(1.0, axis.dot(d))));
        best = std::min(best, widest);
    };
    for (std::size_t i = 0; i < u.size(); ++i)
        for (std::size_t j = i + 1; j < u.size(); ++j) {
            try_axis((u[i] + u[j]).normalized());
            for (std::size_t k = j + 1; k < u.size(); ++k) {
                const Vec3d axis = (u[j] - u[i]).cross(u[k] - u[i]).normalized();
                try_axis(axis);
                try_axis(-axis);
            }
        }
    return best;
}

// [CC95 (1)].
TEST(Cap, SmallestIsThatOfBruteForce) {
    Rng rng(1, Stage::test, 0);
    for (int i = 0; i < 200; ++i) {
        const double spread = i % 2 == 0 ? 0.4 : 1e-3;
        const auto directions = random_directions(3 + static_cast<std::size_t>(i % 9), spread, rng);
        const Cap cap = smallest_cap(directions);
        EXPECT_NEAR(cap.angle(), smallest_angle_by_force(directions), 1e-7);
        const Cap box = box_cap(directions);
        EXPECT_LE(cap.angle(), box.angle() + 1e-7);
        for (const Vec3d& u : directions) {
            EXPECT_GE(cap.axis.dot(u), cap.cosine);
            EXPECT_GE(box.axis.dot(u), box.cosine);
        }
    }
}

TEST(Cap, OfEqualOrOppositeDirections) {
    const std::vector<Vec3d> same(5, Vec3d::UnitX());
    EXPECT_NEAR(smallest_cap(same).angle(), 0, 1e-7);
    const std::vector<Vec3d> opposite = {Vec3d::UnitX(), -Vec3d::UnitX(), Vec3d::UnitY()};
    EXPECT_TRUE(smallest_cap(opposite).is_wide());
    EXPECT_TRUE(smallest_cap({}).is_wide());
}

TEST(Cap, HasAnAngleWhereItsCosineIsRounded) {
    EXPECT_EQ((Cap{Vec3d::UnitX(), std::nextafter(1, 2)}.angle()), 0);
    EXPECT_EQ((Cap{Vec3d::UnitX(), std::nextafter(-1, -2)}.angle()), std::acos(-1));
}

// In all directions: no smallest cap is sought, which would take forever.
TEST(Cap, OfManyDirectionsAllRound) {
    Rng rng(3, Stage::test, 0);
    const auto directions = random_directions(20'000, 30, rng);
    const Cap cap = smallest_cap(directions);
    EXPECT_TRUE(cap.is_wide());
    for (const Vec3d& u : directions) EXPECT_GE(cap.axis.dot(u), cap.cosine);
}

TEST(Circle, SmallestIsThatOfBruteForce) {
    Rng rng(2, Stage::test, 0);
    for (int i = 0; i < 200; ++i) {
        std::vector<Vec2d> points;
        for (int j = 0; j < 3 + i % 9; ++j)
            points.push_back(Vec2(rng.next(), rng.next()).cast<double>());
        const Circle circle = smallest_circle(points);
        for (const Vec2d& p : points) EXPECT_LE((p - circle.centre).norm(), circle.radius);
        // No circle about a centre nearby is smaller.
        for (int j = 0; j < 16; ++j) {
            const Vec2d centre = circle.centre + 1e-4 * Vec2d(std::cos(0.4 * j), std::sin(0.4 * j));
            double radius = 0;
            for (const Vec2d& p : points) radius = std::max(radius, (p - centre).norm());
            EXPECT_GT(radius, circle.radius);
        }
    }
}

TEST(Circle, OfPointsOnALineIsThatOfItsEnds) {
    Rng rng(4, Stage::test, 0);
    for (int i = 0; i < 100; ++i) {
        std::vector<Vec2d> points;
        for (int j = 0; j < 3 + i % 7; ++j)
            points.push_back(static_cast<double>(rng.next()) * Vec2d(1, 2));
        const auto [first, last] = std::ranges::minmax(points, {}, &Vec2d::squaredNorm);
        const Circle circle = smallest_circle(points);
        EXPECT_NEAR(circle.radius, (last - first).norm() / 2, 1e-9);
        EXPECT_NEAR((circle.centre - (first + last) / 2).norm(), 0, 1e-9);
    }
}

// [CC95 (2)].
TEST(Neck, IsTheLeastOfAConvexSize) {
    for (const double at : {0.0, 0.001, 0.3, 0.77, 0.999, 1.0, 3.0, -2.0}) {
        const auto size = [at](double t) { return std::sqrt(0.01 + (t - at) * (t - at)); };
        const double truth = std::min(1.0, std::max(0.0, at));
        EXPECT_LE(size(find_neck(size, 0, 1)), size(truth) * 1.001) << at;
        const auto kink = [at](double t) { return 0.1 + std::abs(t - at) * (t < at ? 3 : 0.5); };
        EXPECT_LE(kink(find_neck(kink, 0, 1)), kink(truth) * 1.01) << at;
    }
}

}  // namespace
}  // namespace caustics::beamtree

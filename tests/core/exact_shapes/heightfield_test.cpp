#include "core/exact_shapes/heightfield.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace caustics {
namespace {

SineHeightfield choppy() {
    SineHeightfield field;
    field.waves = {{0.1, {3, 1}, 0.2}, {-0.05, {-2, 5}, 1.1}, {0.02, {0, 9}, -0.7}};
    field.half_size = {2, 1.5};
    return field;
}

template <class Check>
void at_many_points(const SineHeightfield& field, Check check) {
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40; ++j)
            check(
                Vec2d((i / 20.0 - 1) * field.half_size.x(), (j / 20.0 - 1) * field.half_size.y()));
}

TEST(Heightfield, OneWaveIsASine) {
    SineHeightfield field;
    field.waves = {{0.5, {2, 0}, 0.25}};
    EXPECT_DOUBLE_EQ(field.height({0.3, 7}), 0.5 * std::sin(0.85));
    EXPECT_DOUBLE_EQ(field.gradient({0.3, 7}).x(), std::cos(0.85));
    EXPECT_EQ(field.gradient({0.3, 7}).y(), 0);
}

TEST(Heightfield, WithoutWavesIsThePlane) {
    const SineHeightfield field;
    EXPECT_EQ(field.height({0.3, 0.4}), 0);
    EXPECT_EQ(field.normal({0.3, 0.4}), Vec3d::UnitZ());
    EXPECT_EQ(field.max_height(), 0);
    EXPECT_EQ(field.max_curvature(), 0);
}

TEST(Heightfield, GradientIsTheLimitOfDifferences) {
    const SineHeightfield field = choppy();
    const double step = 1e-5;
    at_many_points(field, [&](const Vec2d& xy) {
        for (int axis = 0; axis < 2; ++axis) {
            const Vec2d shift = step * Vec2d::Unit(axis);
            const double slope = (field.height(xy + shift) - field.height(xy - shift)) / (2 * step);
            // Error of central differences: step^2 / 6 times the third derivative, below 10 * 81.
            EXPECT_NEAR(field.gradient(xy)[axis], slope, 1e-8);
        }
    });
}

TEST(Heightfield, NormalIsUnitUpAndAcrossBothTangents) {
    const SineHeightfield field = choppy();
    at_many_points(field, [&](const Vec2d& xy) {
        const Vec3d normal = field.normal(xy);
        const Vec2d slope = field.gradient(xy);
        EXPECT_NEAR(normal.norm(), 1, 1e-15);
        EXPECT_GT(normal.z(), 0);
        EXPECT_NEAR(normal.dot(Vec3d(1, 0, slope.x())), 0, 1e-15);
        EXPECT_NEAR(normal.dot(Vec3d(0, 1, slope.y())), 0, 1e-15);
    });
}

TEST(Heightfield, BoundsHoldAndAreNotLoose) {
    const SineHeightfield field = choppy();
    const double step = 1e-4;
    double highest = 0;
    double most_curved = 0;
    at_many_points(field, [&](const Vec2d& xy) {
        highest = std::max(highest, std::abs(field.height(xy)));
        for (int turn = 0; turn < 12; ++turn) {
            const Vec2d d(std::cos(pi_d * turn / 12), std::sin(pi_d * turn / 12));
            const double curvature =
                (field.gradient(xy + step * d) - field.gradient(xy - step * d)).dot(d) / (2 * step);
            most_curved = std::max(most_curved, std::abs(curvature));
        }
    });
    EXPECT_LE(highest, field.max_height());
    EXPECT_LE(most_curved, field.max_curvature());
    EXPECT_GT(highest, 0.8 * field.max_height());
    EXPECT_GT(most_curved, 0.5 * field.max_curvature());
}

TEST(Heightfield, BoundOfOneWaveIsReached) {
    SineHeightfield field;
    field.waves = {{-0.5, {3, 4}, pi_d / 2}};
    EXPECT_DOUBLE_EQ(field.max_height(), 0.5);
    EXPECT_DOUBLE_EQ(field.max_curvature(), 0.5 * 25);
    EXPECT_DOUBLE_EQ(field.height(Vec2d::Zero()), -0.5);
}

/// Waves that cancel each other leave a plane, and a bound of its curvature with which a ray that comes down slowly
/// takes six million steps.
TEST(Heightfield, ARayThatTakesMillionsOfSafeStepsMeetsItStill) {
    SineHeightfield field;
    field.waves = {{0.05, {3e4, 0}, 0}, {-0.05, {3e4, 0}, 0}};
    const Heightfield shape{field};
    const auto hit = shape.intersect({-1, 0.1, 2.1e-5}, {1, 0, -1e-5}, {0, 10});
    EXPECT_FALSE(hit) << "it leaves the rectangle at its height";
    const auto lower = shape.intersect({-1, 0.1, 1.9e-5}, {1, 0, -1e-5}, {0, 10});
    ASSERT_TRUE(lower);
    EXPECT_NEAR(lower->distance, 1.9, 1e-9);
}

}  // namespace
}  // namespace caustics

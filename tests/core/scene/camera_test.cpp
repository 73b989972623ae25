#include "core/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

Camera tilted_camera() {
    Camera camera = support::camera({1, 2, 3}, {-4, 0.5, 1}, {0.1, 0.2, 1}, 65, 37, 21);
    return camera;
}

TEST(Camera, EachFovAxisSpansTheFieldOfView) {
    using Axis = Camera::FovAxis;
    const double tangent = std::tan(pi_d / 6);
    for (const auto& [width, height] : {std::pair{40, 30}, std::pair{30, 40}, std::pair{8, 8}}) {
        Camera camera;
        camera.fov_degrees = 60;
        camera.width = width;
        camera.height = height;
        const double aspect = double(width) / height;
        const auto half = [&](Axis axis) {
            camera.fov_axis = axis;
            const Vec2d extent = camera.half_extent();
            EXPECT_NEAR(extent.x() / extent.y(), aspect, 1e-12);
            return extent;
        };
        EXPECT_NEAR(half(Axis::x).x(), tangent, 1e-12);
        EXPECT_NEAR(half(Axis::y).y(), tangent, 1e-12);
        EXPECT_NEAR(half(Axis::diagonal).norm(), tangent, 1e-12);
        EXPECT_NEAR(half(Axis::smaller).minCoeff(), tangent, 1e-12);
        EXPECT_NEAR(half(Axis::larger).maxCoeff(), tangent, 1e-12);
    }
}

TEST(Camera, LeftIsLeftAndUpIsUp) {
    const Camera camera = support::camera({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60, 40, 30);
    // Looking along +y with z up: the picture's left is -x.
    EXPECT_LT(camera.direction(0, 15).x(), 0);
    EXPECT_GT(camera.direction(40, 15).x(), 0);
    EXPECT_GT(camera.direction(20, 0).z(), 0);
    EXPECT_LT((camera.direction(20, 15) - Vec3::UnitY()).norm(), 1e-6F);
}

TEST(Camera, ProjectionUndoesDirection) {
    const Camera camera = tilted_camera();
    Rng rng(1, Stage::test, 0);
    for (int i = 0; i < 10'000; ++i) {
        const double x = static_cast<double>(rng.next()) * camera.width;
        const double y = static_cast<double>(rng.next()) * camera.height;
        if (std::min(x, y) < 1e-4 || x > camera.width - 1e-4 || y > camera.height - 1e-4) continue;
        const float distance = 0.1F + 10 * rng.next();
        const Vec3 direction = camera.direction(x, y);
        EXPECT_NEAR(direction.norm(), 1, 1e-6F);
        const auto seen = FilmProjection(camera).project(camera.position() + distance * direction);
        ASSERT_TRUE(seen) << x << " " << y;
        EXPECT_NEAR(seen->x, x, 1e-3);
        EXPECT_NEAR(seen->y, y, 1e-3);
        EXPECT_NEAR(seen->distance, distance, 1e-4);
        const Vec3d axis = camera.to_world.linear().col(2);
        EXPECT_NEAR(seen->cos_theta, axis.dot(direction.cast<double>()), 1e-5);
    }
}

TEST(Camera, SeesNothingBehindOrBesideTheFilm) {
    const Camera camera = tilted_camera();
    const Vec3 forward = camera.direction(18, 10);
    EXPECT_FALSE(FilmProjection(camera).project(camera.position() - forward));
    EXPECT_FALSE(FilmProjection(camera).project(camera.position()));
    EXPECT_FALSE(FilmProjection(camera).project(camera.position() + camera.direction(-0.5, 10)));
    EXPECT_FALSE(FilmProjection(camera).project(camera.position() + camera.direction(18, 21.5)));
    EXPECT_TRUE(FilmProjection(camera).project(camera.position() + camera.direction(0.5, 0.5)));
}

// The solid angle of the film two ways: sum of pixel_area cos^3, and the pyramid's closed form.
TEST(Camera, PixelAreaIsTheMeasureOfTheFilm) {
    const Camera camera = tilted_camera();
    const Vec3d axis = camera.to_world.linear().col(2);
    double sum = 0;
    constexpr int steps = 8;
    for (int i = 0; i < camera.width * steps; ++i)
        for (int j = 0; j < camera.height * steps; ++j) {
            const Vec3 d = camera.direction((i + 0.5) / steps, (j + 0.5) / steps);
            sum += std::pow(axis.dot(d.cast<double>()), 3) * camera.pixel_area() / (steps * steps);
        }
    const Vec2d half = camera.half_extent();
    const double pyramid =
        4 * std::asin(half.x() * half.y() /
                      std::sqrt((1 + half.x() * half.x()) * (1 + half.y() * half.y())));
    EXPECT_NEAR(sum, pyramid, 1e-4 * pyramid);
}

}  // namespace
}  // namespace caustics

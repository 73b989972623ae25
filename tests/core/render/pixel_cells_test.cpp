#include "core/render/pixel_cells.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/render/camera_samples.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

ReceiverPoint on_plane(const Vec3d& position, const Vec3d& normal) {
    ReceiverPoint point;
    point.position = position.cast<float>();
    point.geometric_normal = normal.cast<float>();
    return point;
}

// On the point's plane, and under the film's corners.
TEST(PixelCell, IsWhatTheCameraSees) {
    const Camera camera = support::camera({1, -4, 3}, {0.2, 0, 0}, {0, 0, 1}, 40, 64, 48);
    const Vec3d normal = Vec3d(0.1, -0.3, 1).normalized().cast<float>().cast<double>();
    const ReceiverPoint point = on_plane({0.1, 0.2, -0.1}, normal);
    const Eigen::AlignedBox2d film(Vec2d(31, 20), Vec2d(31.5, 20.5));
    const auto cell = pixel_cell(camera, film, point);
    ASSERT_TRUE(cell);
    const std::array<Vec2d, 4> seen = {Vec2d(31, 20), Vec2d(31.5, 20), Vec2d(31.5, 20.5),
                                       Vec2d(31, 20.5)};
    const FilmProjection projection(camera);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(cell->corner(i).dot(normal), 0, 1e-7 * cell->corner(i).norm());
        const Vec3d corner = point.position.cast<double>() + cell->corner(i);
        const auto at = projection.project(corner.cast<float>());
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->x, seen[i].x(), 1e-4);
        EXPECT_NEAR(at->y, seen[i].y(), 1e-4);
    }
}

// Areas on the film are in the ratios of the picture: here quarters of a pixel, seen obliquely.
TEST(PixelCell, KnowsAreasOfThePicture) {
    const Camera camera = support::camera({0, -2, 0.5}, {0, 0, 0}, {0, 0, 1}, 40, 4, 4);
    const ReceiverPoint point = on_plane({0.02, 0.1, 0}, Vec3d::UnitZ());
    const auto area = [&](const Eigen::AlignedBox2d& film, const PixelCell& by) {
        const PixelCell cell = pixel_cell(camera, film, point).value();
        std::array<Vec2d, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = by.on_film(cell.corners[i]);
        return std::abs(cross(p[2] - p[0], p[3] - p[1])) / 2;
    };
    const Eigen::AlignedBox2d whole(Vec2d(1, 1.9), Vec2d(2, 2.9));
    const PixelCell cell = pixel_cell(camera, whole, point).value();
    for (const Vec2d& corner : {Vec2d(1, 1.9), Vec2d(1.5, 1.9), Vec2d(1.5, 2.4), Vec2d(1, 2.4)}) {
        const Eigen::AlignedBox2d quarter(corner, corner + Vec2d(0.5, 0.5));
        EXPECT_NEAR(area(quarter, cell) / area(whole, cell), 0.25, 1e-7);
    }
}

TEST(PixelCell, HasNoHorizon) {
    const Camera camera = support::camera({0, 0, 1}, {0, 1, 1}, {0, 0, 1}, 60, 8, 8);
    const ReceiverPoint point = on_plane({0, 20, 0}, Vec3d::UnitZ());
    EXPECT_TRUE(pixel_cell(camera, {Vec2d(4, 5), Vec2d(5, 6)}, point));
    EXPECT_FALSE(pixel_cell(camera, {Vec2d(4, 3.5), Vec2d(5, 4.5)}, point));
    EXPECT_FALSE(pixel_cell(camera, {Vec2d(4, 2), Vec2d(5, 3)}, point));
}

// The samples' cells cover their pixel once; strata hold their samples.
TEST(PixelCell, CoversThePixel) {
    for (const auto& [stratified, count] :
         {std::pair{true, 9}, std::pair{false, 9}, std::pair{false, 6}, std::pair{false, 5}}) {
        SceneDesc desc;
        desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))};
        desc.camera = support::camera({0, 0, 2}, {0, 0.1, 0}, {0, 1, 0}, 20, 4, 4);
        desc.sampling.stratified = stratified;
        const Scene scene(std::move(desc));
        RunOptions options;
        options.samples_per_pixel = count;
        const CameraSamples samples(scene, options, count);
        const Eigen::AlignedBox2d pixel(Vec2d(2, 1), Vec2d(3 + 1e-12, 2 + 1e-12));
        std::vector<Eigen::AlignedBox2d> cells;
        double area = 0;
        for (int i = 0; i < count; ++i) {
            Rng rng(0, Stage::eye, samples.id(2, 1, i));
            const Vec2d at = samples.film_point(2, 1, i, rng);
            cells.push_back(samples.film_cell(2, 1, i));
            EXPECT_TRUE(!stratified || cells.back().contains(at));
            EXPECT_TRUE(pixel.contains(cells.back()));
            area += cells.back().volume();
            for (int j = 0; j < i; ++j) {
                const auto both = cells[static_cast<std::size_t>(j)].intersection(cells.back());
                EXPECT_TRUE(both.isEmpty() || both.volume() < 1e-12);
            }
        }
        EXPECT_NEAR(area, 1, 1e-12);
    }
}

}  // namespace
}  // namespace caustics

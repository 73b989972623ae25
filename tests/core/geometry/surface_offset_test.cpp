#include "core/geometry/surface_offset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "tests/support/build_scene.h"
#include "tests/support/random_direction.h"

namespace caustics {
namespace {

using support::random_direction;

Vec3d point_in_cube(Rng& rng, double half) {
    const double x = rng.next_fine(), y = rng.next_fine(), z = rng.next_fine();
    return half * (2 * Vec3d(x, y, z) - Vec3d::Ones());
}

// Sizes and distances over seven powers of ten.
double random_scale(Rng& rng) { return std::pow(10.0, 7 * rng.next_fine() - 3.5); }

Shape random_triangle(Rng& rng) {
    const double size = random_scale(rng);
    const Vec3d middle = point_in_cube(rng, rng.next() < 0.5F ? size : random_scale(rng));
    TriangleMesh mesh;
    for (int i = 0; i < 3; ++i)
        mesh.positions.push_back((middle + point_in_cube(rng, size)).cast<float>());
    mesh.triangles = {{0, 1, 2}};
    return support::mesh("triangle", mesh, Transform::Identity(), support::diffuse(0.5F));
}

Shape random_exact(Rng& rng) {
    const double size = random_scale(rng);
    const Vec3d middle = point_in_cube(rng, rng.next() < 0.5F ? size : 30 * size);
    const Transform turned =
        Eigen::Translation3d(middle) *
        Eigen::AngleAxisd(3 * rng.next_fine(), random_direction(rng).cast<double>().normalized()) *
        Eigen::Scaling(size);
    Shape shape;
    shape.primitive = rng.next() < 0.5F ? Primitive::rectangle : Primitive::sphere;
    shape.to_world = turned;
    shape.bsdf = support::diffuse(0.5F);
    return shape;
}

/// Rays from outside to places of the shape's bounds.
Ray random_ray(const Box& box, Rng& rng) {
    const Vec3d size = box.sizes().cast<double>();
    const Vec3d half = point_in_cube(rng, 0.5);
    const Vec3d target = box.center().cast<double>() + size.cwiseProduct(half);
    const Vec3d from = target + 3 * size.norm() * random_direction(rng).cast<double>();
    return {from.cast<float>(), (target - from).normalized().cast<float>()};
}

// A ray that leaves a flat surface does not meet it again, on either side, down to 0.6 degrees of it;
// one that leaves a ball outwards does not meet the ball.
void expect_rays_get_away(Shape (*random_shape)(Rng&), int shapes, std::uint64_t path) {
    Rng rng(1, Stage::test, path);
    int tried = 0;
    int caught = 0;
    for (int i = 0; i < shapes; ++i) {
        SceneDesc desc;
        desc.shapes.push_back(random_shape(rng));
        const bool flat = desc.shapes[0].primitive != Primitive::sphere;
        const Scene scene(std::move(desc));
        for (int k = 0; k < 20; ++k) {
            const auto hit = scene.intersect(random_ray(scene.bounds(), rng));
            if (!hit) continue;
            Vec3 direction = random_direction(rng);
            if (!flat && hit->geometric_normal.dot(direction) < 0) direction = -direction;
            if (std::abs(hit->geometric_normal.dot(direction)) < 0.01F) continue;
            ++tried;
            const SegmentEnd end{hit->position, hit->geometric_normal, hit->offset};
            caught += scene.occluded_along(end, direction) ? 1 : 0;
            const SegmentEnd free{hit->position + 2 * scene.diameter() * direction};
            // Nor does the line of sight back to it end before it, if it does not skim the surface.
            if (std::abs(hit->geometric_normal.dot(direction)) > 0.1F)
                caught += scene.occluded(free, end) ? 1 : 0;
            caught += scene.occluded(end, free) ? 1 : 0;
        }
    }
    EXPECT_GT(tried, shapes);
    EXPECT_EQ(caught, 0) << "of " << tried;
}

TEST(SurfaceOffset, RaysGetAwayFromTriangles) { expect_rays_get_away(random_triangle, 5000, 0); }

TEST(SurfaceOffset, RaysGetAwayFromExactShapes) { expect_rays_get_away(random_exact, 3000, 1); }

TEST(SurfaceOffset, FollowsTheHitAndNotTheShape) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1e4, true, support::diffuse(0.5F))};
    const Scene scene(std::move(desc));
    const auto near = scene.intersect({Vec3(0.001F, 0, 1), -Vec3::UnitZ()});
    const auto far = scene.intersect({Vec3(5000, 0, 1), -Vec3::UnitZ()});
    ASSERT_TRUE(near && far);
    EXPECT_FLOAT_EQ(far->offset, 0x1p-22F * 5000);
    EXPECT_LT(near->offset, 2e-8F) << "of a floor of 10 km";
}

}  // namespace
}  // namespace caustics

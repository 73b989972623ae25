#include "core/geometry/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/exact_shape.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// Rotation, translation and a scale by axis; a uniform one where the shape must stay round.
Transform placed(const Vec3d& scale) {
    return Eigen::Translation3d(1, -2, 3) * Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()) *
           Eigen::Scaling(scale);
}

Shape exact(Primitive primitive, const Vec3d& scale) {
    Shape shape;
    shape.primitive = primitive;
    shape.to_world = placed(scale);
    return shape;
}

std::vector<Shape> sampled_shapes() {
    std::vector<Shape> shapes = {
        exact(Primitive::rectangle, {0.5, 2, 1}), exact(Primitive::disk, {0.5, 2, 1}),
        exact(Primitive::sphere, {0.3, 0.3, 0.3}), exact(Primitive::cylinder, {0.5, 0.5, 3})};
    const std::size_t primitives = shapes.size();
    for (std::size_t i = 0; i < primitives; ++i) {
        shapes.push_back(shapes[i]);
        shapes.back().flip_normals = true;
    }
    return shapes;
}

double closed_form_area(Primitive primitive) {
    switch (primitive) {
        case Primitive::rectangle: return 4 * 0.5 * 2;
        case Primitive::disk: return pi_d * 0.5 * 2;
        case Primitive::sphere: return 4 * pi_d * 0.3 * 0.3;
        default: return 2 * pi_d * 0.5 * 3;
    }
}

// Texture coordinates of uniform points, made uniform in both: a disk's u is its radius, a
// sphere's v its polar angle.
Vec2d even_coordinates(const Shape& shape, const Vec3d& local) {
    Vec2d uv = exact_uv(shape, local).cast<double>();
    if (shape.primitive == Primitive::disk) uv.x() = uv.x() * uv.x();
    if (shape.primitive == Primitive::sphere) uv.y() = (1 - std::cos(pi_d * uv.y())) / 2;
    return uv;
}

TEST(AreaSampler, IsUniformByAreaOnEveryExactShape) {
    constexpr std::size_t cells = 16;
    constexpr int draws = 50'000;
    for (const Shape& shape : sampled_shapes()) {
        const AreaSampler sampler(shape);
        EXPECT_NEAR(sampler.area() / closed_form_area(shape.primitive), 1, 1e-9);
        const Transform to_local = shape.to_world.inverse();
        std::vector<double> counts(cells * cells);
        Rng rng(1, Stage::test, 0);
        for (int i = 0; i < draws; ++i) {
            const float u0 = rng.next();
            const auto sample = sampler.sample(shape, u0, rng.next());
            const Vec3d local = to_local * sample.position.cast<double>();
            const Vec2d uv = even_coordinates(shape, local);
            const auto cell = [](double u) {
                return static_cast<std::size_t>(std::clamp(u, 0.0, 0.999999) * cells);
            };
            counts[cell(uv.x()) * cells + cell(uv.y())] += 1;
            // The normal stands on two tangents, differences of the surface's points.
            const Vec3d n = shape.to_world.linear().inverse().transpose() *
                            exact_normal(shape, local) * (shape.flip_normals ? -1 : 1);
            ASSERT_LT((n.normalized().cast<float>() - sample.normal).norm(), 1e-5F);
        }
        const std::vector<double> each(cells * cells, double{draws} / (cells * cells));
        EXPECT_GT(support::chi_square_p_value(counts, each), 1e-3)
            << static_cast<int>(shape.primitive);
    }
}

TEST(AreaSampler, PicksTrianglesByArea) {
    // Triangles of very different areas, one without any.
    Shape shape;
    shape.primitive = Primitive::mesh;
    shape.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {0, 2, 5}, {0, 0, 9}};
    shape.mesh.triangles = {{0, 1, 1}, {0, 1, 2}, {3, 4, 5}};
    const AreaSampler sampler(shape);
    EXPECT_NEAR(sampler.area(), 0.5 + 4, 1e-12);
    support::Moments first, centroid_x, centroid_y, centroid_z;
    Rng rng(2, Stage::test, 0);
    EXPECT_TRUE(sampler.sample(shape, 0, 0).normal.allFinite());
    EXPECT_TRUE(sampler.sample(shape, 0x1.fffffep-1F, 0x1.fffffep-1F).position.allFinite());
    for (int i = 0; i < 100'000; ++i) {
        const float u0 = rng.next();
        const auto sample = sampler.sample(shape, u0, rng.next());
        const bool small = sample.position.z() < 2;
        first.add(small ? 1 : 0);
        const Vec3 expected = small ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
        ASSERT_LT((sample.normal - expected).norm(), 1e-6F);
        if (small) {
            centroid_x.add(static_cast<double>(sample.position.x()));
            centroid_y.add(static_cast<double>(sample.position.y()));
        } else {
            centroid_z.add(static_cast<double>(sample.position.z()));
        }
    }
    EXPECT_NEAR(first.mean(), 0.5 / 4.5, 4 * first.standard_error());
    EXPECT_NEAR(centroid_x.mean(), 1.0 / 3, 4 * centroid_x.standard_error());
    EXPECT_NEAR(centroid_y.mean(), 1.0 / 3, 4 * centroid_y.standard_error());
    EXPECT_NEAR(centroid_z.mean(), 19.0 / 3, 4 * centroid_z.standard_error());
}

// Of a triangle's area the share (1 - a)^2 lies beyond the line of weight a at the first corner, and the
// points of that line are even.
TEST(AreaSampler, IsUniformByAreaOnEveryTriangle) {
    constexpr std::size_t cells = 12;
    constexpr int draws = 100'000;
    Shape shape;
    shape.primitive = Primitive::mesh;
    shape.mesh.positions = {{0, 0, 0}, {3, 0, 0}, {1, 2, 0}, {0, 0, 5}, {0, 2, 5}, {0, 1, 6}};
    shape.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    const AreaSampler sampler(shape);
    std::vector<double> counts, expected;
    for (const double area : {3.0, 1.0}) {
        counts.resize(counts.size() + cells * cells);
        expected.resize(counts.size(), draws * area / (4 * cells * cells));
    }
    Rng rng(3, Stage::test, 0);
    for (int i = 0; i < draws; ++i) {
        const float u0 = rng.next();
        const Vec3d p = sampler.sample(shape, u0, rng.next()).position.cast<double>();
        const bool first = p.z() < 2;
        // Weights of the second and the third corner.
        const double c = first ? p.y() / 2 : p.z() - 5;
        const double b = first ? (p.x() - c) / 3 : (p.y() - c) / 2;
        const auto cell = [](double u) {
            return static_cast<std::size_t>(std::clamp(u, 0.0, 0.999999) * cells);
        };
        const std::size_t at = cell((b + c) * (b + c)) * cells + cell(c / (b + c));
        counts[(first ? 0 : cells * cells) + at] += 1;
    }
    EXPECT_GT(support::chi_square_p_value(counts, expected), 1e-3);
}

TEST(AreaSampler, MeshAreasApproachTheExactOnes) {
    const Shape mesh = support::mesh("ball", tessellate_sphere(64), placed({2, 2, 2}), {});
    EXPECT_NEAR(AreaSampler(mesh).area(), 16 * pi_d, 0.01 * 16 * pi_d);
}

TEST(Shape, BoundsHoldTheSurfaceTightly) {
    for (const Shape& shape : sampled_shapes()) {
        const AreaSampler sampler(shape);
        const Box box = bounds(shape);
        const BoundingSphere ball = bounding_sphere(shape);
        Box seen;
        Rng rng(3, Stage::test, 0);
        for (int i = 0; i < 20'000; ++i) {
            const float u0 = rng.next();
            const Vec3 p = sampler.sample(shape, u0, rng.next()).position;
            seen.extend(p);
            ASSERT_LE((p - ball.centre).norm(), ball.radius * (1 + 1e-5F) + 1e-5F);
        }
        EXPECT_TRUE((box.min().array() <= seen.min().array() + 1e-5F).all());
        EXPECT_TRUE((box.max().array() >= seen.max().array() - 1e-5F).all());
        // Exact for the sphere, the local box's corners for the others.
        if (shape.primitive == Primitive::sphere) {
            EXPECT_LT((box.sizes() - seen.sizes()).norm(), 0.01F);
        }
    }
}

TEST(Shape, BoundsOfAMeshAreItsVertices) {
    const Shape cube = support::mesh("cube", tessellate_cube(1), placed({1, 2, 3}), {});
    Box box;
    for (const Vec3& p : cube.mesh.positions) box.extend(p);
    EXPECT_TRUE(bounds(cube).isApprox(box));
    EXPECT_EQ(triangle_count(cube), 12U);
    EXPECT_EQ(triangle_count(exact(Primitive::disk, {1, 1, 1})), 0U);
    EXPECT_NEAR(bounding_sphere(cube).radius, std::sqrt(14.0F), 1e-4F);
}

}  // namespace
}  // namespace caustics

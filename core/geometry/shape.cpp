#include "core/geometry/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/geometry/along_normal.h"
#include "core/geometry/surface_offset.h"
#include "core/math/sampling.h"
#include "core/mesh/exact_positions.h"

namespace caustics {
namespace {

Vec3 world_normal(const Shape& shape, const Vec3d& local_normal) {
    const Eigen::Matrix3d inverse_transpose = shape.to_world.linear().inverse().transpose();
    const Vec3d n = (inverse_transpose * local_normal).normalized();
    return (shape.flip_normals ? Vec3d(-n) : n).cast<float>();
}

Box box_of(std::span<const Vec3> points) {
    Box box;
    for (const Vec3& p : points) box.extend(p);
    return box;
}

// 0 of what cannot emit.
double exact_area(const Shape& shape) {
    if (shape.primitive == Primitive::mesh) return 0;
    return ask_exact(shape, [&](const auto& kind) -> double {
        if constexpr (requires { kind.area(shape.to_world.linear()); })
            return kind.area(shape.to_world.linear());
        else
            return 0;
    });
}

// A point of an exact shape in its frame, uniform by area, and its normal.
std::pair<Vec3d, Vec3d> sample_local(const Shape& shape, float u0, float u1) {
    return ask_exact(shape, [&](const auto& kind) -> std::pair<Vec3d, Vec3d> {
        if constexpr (requires { kind.sample(u0, u1); })
            return kind.sample(u0, u1);
        else
            throw std::logic_error("an exact shape that cannot emit has no sampler");
    });
}

AreaSampler::Sample sample_triangle(const TriangleMesh& mesh, std::size_t index, float u0,
                                    float u1) {
    const auto& [a, b, c] = mesh.triangles[index];
    const double root = std::sqrt(static_cast<double>(u0));
    const auto side = static_cast<double>(u1);
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const Vec3d position = (1 - root) * p.cast<double>() + root * (1 - side) * q.cast<double>() +
                           root * side * r.cast<double>();
    AreaSampler::Sample sample{position.cast<float>(), along_normal(q - p, r - p).normalized(), 0};
    sample.offset = triangle_offset(sample.position, sample.normal, p, q, r);
    return sample;
}

}  // namespace

Eigen::AlignedBox3d local_bounds(const Shape& shape) {
    if (shape.primitive != Primitive::mesh)
        return ask_exact(shape, [](const auto& kind) { return kind.bounds(); });
    return exact_bounds(shape.mesh);
}

std::span<const Vec3> hull_points(const Shape& shape, std::vector<Vec3>& corners) {
    if (shape.primitive == Primitive::mesh) return shape.mesh.positions;
    const Eigen::AlignedBox3d box = local_bounds(shape);
    corners.clear();
    for (int i = 0; i < 8; ++i)
        corners.push_back(
            Vec3d(shape.to_world * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)))
                .cast<float>());
    return corners;
}

Box bounds(const Shape& shape) {
    if (shape.primitive == Primitive::sphere) {
        const BoundingSphere sphere = bounding_sphere(shape);
        const Vec3 half = Vec3::Constant(sphere.radius);
        return {sphere.centre - half, sphere.centre + half};
    }
    std::vector<Vec3> corners;
    return box_of(hull_points(shape, corners));
}

BoundingSphere bounding_sphere(const Shape& shape) {
    if (shape.primitive == Primitive::sphere)
        return {Vec3d(shape.to_world.translation()).cast<float>(),
                static_cast<float>(shape.to_world.linear().col(0).norm())};
    std::vector<Vec3> corners;
    return bounding_sphere(hull_points(shape, corners));
}

BoundingSphere bounding_sphere(std::span<const Vec3> points) {
    BoundingSphere sphere{box_of(points).center(), 0};
    for (const Vec3& p : points)
        sphere.radius = std::max(sphere.radius, (p - sphere.centre).norm());
    return sphere;
}

std::size_t triangle_count(const Shape& shape) { return shape.mesh.triangles.size(); }

float least_offset(const Shape& shape) {
    const Box box = bounds(shape);
    return 0x1p-40F * box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff();
}

AreaSampler::AreaSampler(const Shape& shape)
    : area_(exact_area(shape)), least_offset_(caustics::least_offset(shape)) {
    if (shape.primitive != Primitive::mesh) return;
    for (const auto& [a, b, c] : shape.mesh.triangles) {
        const Vec3d p = shape.mesh.positions[a].cast<double>();
        const Vec3d e1 = shape.mesh.positions[b].cast<double>() - p;
        const Vec3d e2 = shape.mesh.positions[c].cast<double>() - p;
        area_ += e1.cross(e2).norm() / 2;
        cumulative_.push_back(area_);
    }
    for (double& share : cumulative_) share /= area_;
}

AreaSampler::Sample AreaSampler::sample(const Shape& shape, float u0, float u1) const {
    if (shape.primitive != Primitive::mesh) {
        const auto [p, n] = sample_local(shape, u0, u1);
        const Vec3 position = Vec3d(shape.to_world * p).cast<float>();
        return {position, world_normal(shape, n),
                std::max(rounding_offset(position), least_offset_)};
    }
    // The first number picks the triangle and its remainder is used again.
    const std::size_t index = pick(cumulative_, u0);
    const double low = index == 0 ? 0 : cumulative_[index - 1];
    const double rest = (static_cast<double>(u0) - low) / (cumulative_[index] - low);
    return sample_triangle(shape.mesh, index, std::clamp(static_cast<float>(rest), 0.0F, 1.0F), u1);
}

}  // namespace caustics

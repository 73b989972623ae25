#include "core/scene/placed_surfaces.h"

#include <algorithm>

#include "core/base/interrupt.h"
#include "core/geometry/along_normal.h"
#include "core/geometry/surface_offset.h"

namespace caustics {

std::optional<ExactHit> PlacedExact::intersect(const Vec3& origin, const Vec3& direction,
                                               float t_min, float t_max) const {
    const Vec3d o = to_local_ * origin.cast<double>();
    const Vec3d d = to_local_.linear() * direction.cast<double>();
    return intersect_exact(*shape_, o, d, static_cast<double>(t_min), static_cast<double>(t_max));
}

void PlacedExact::fill(const Vec3d& local, SurfacePoint& point) const {
    const Vec3d n = to_local_.linear().transpose() * exact_normal(*shape_, local);
    point.position = Vec3d(shape_->to_world * local).cast<float>();
    point.offset = std::max(rounding_offset(point.position), least_offset_);
    point.geometric_normal = n.normalized().cast<float>();
    if (shape_->flip_normals) point.geometric_normal = -point.geometric_normal;
    point.shading_normal = point.geometric_normal;
    point.uv = exact_uv(*shape_, local);
}

std::optional<SurfacePoint> PlacedExact::meet(const Ray& ray) const {
    const auto hit = intersect(ray.origin, ray.direction, 0, ray.max_distance);
    if (!hit) return {};
    SurfacePoint point;
    point.distance = static_cast<float>(hit->distance);
    fill(hit->local, point);
    return point;
}

PlacedMesh::PlacedMesh(const Shape& shape)
    : shape_(&shape), smooth_(!shape.mesh.normals.empty()), mapped_(!shape.mesh.uvs.empty()) {
    const TriangleMesh& mesh = shape.mesh;
    vertices_.reserve(mesh.positions.size());
    constexpr std::size_t vertices_between_looks = 1 << 16;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (i % vertices_between_looks == 0) throw_if_interrupted();
        const Vec2 uv = mapped_ ? mesh.uvs[i] : Vec2(Vec2::Zero());
        const Vec3 normal = smooth_ ? mesh.normals[i] : Vec3(Vec3::Zero());
        vertices_.push_back({mesh.positions[i], uv.x(), normal, uv.y()});
    }
}

void PlacedMesh::fill(std::uint32_t triangle, float u, float v, SurfacePoint& point) const {
    const auto& [i, j, k] = shape_->mesh.triangles[triangle];
    const Vertex& a = vertices_[i];
    const Vertex& b = vertices_[j];
    const Vertex& c = vertices_[k];
    const float w = 1 - u - v;
    // In double, so that the point lies on the plane to its own rounding, however large the triangle.
    point.position = (static_cast<double>(w) * a.position.cast<double>() +
                      static_cast<double>(u) * b.position.cast<double>() +
                      static_cast<double>(v) * c.position.cast<double>())
                         .cast<float>();
    const Vec3 across = along_normal(b.position - a.position, c.position - a.position);
    const float length = across.norm();
    point.geometric_normal = length > 0 ? Vec3(across * (1 / length)) : across;
    point.offset =
        triangle_offset(point.position, point.geometric_normal, a.position, b.position, c.position);
    point.shading_normal = point.geometric_normal;
    if (smooth_) {
        const Vec3 n = w * a.normal + u * b.normal + v * c.normal;
        const float mean = n.norm();
        if (mean > 0) point.shading_normal = n * (1 / mean);
    }
    point.uv =
        mapped_ ? Vec2(w * Vec2(a.u, a.v) + u * Vec2(b.u, b.v) + v * Vec2(c.u, c.v)) : Vec2(u, v);
}

}  // namespace caustics

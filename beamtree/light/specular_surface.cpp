#include "beamtree/light/specular_surface.h"

#include <limits>

#include "core/geometry/exact_shape.h"

namespace caustics::beamtree {
namespace {

// The derivative of v / |v| where v changes by `change`.
Vec3d unit_change(const Vec3d& v, const Vec3d& change) {
    const double length = v.norm();
    const Vec3d n = v / length;
    return (change - n.dot(change) * n) / length;
}

}  // namespace

SpecularSurface::SpecularSurface(const Shape& exact)
    : shape_(&exact), to_world_(exact.to_world), to_local_(exact.to_world.inverse()) {}

SpecularSurface::SpecularSurface(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& [i, j, k] = mesh.triangles[triangle];
    const Vec3d a = mesh.positions[i].cast<double>();
    const Vec3d u = mesh.positions[j].cast<double>() - a;
    const Vec3d v = mesh.positions[k].cast<double>() - a;
    plane_.corner = a;
    plane_.across = u.cross(v).stableNormalized();
    const double area = plane_.across.dot(u.cross(v));
    plane_.gradient = {v.cross(plane_.across) / area, plane_.across.cross(u) / area};
    plane_.is_flat = true;
    plane_.normal = plane_.across;
    if (mesh.normals.empty()) return;
    plane_.normal = mesh.normals[i].cast<double>();
    plane_.along = {mesh.normals[j].cast<double>() - plane_.normal,
                    mesh.normals[k].cast<double>() - plane_.normal};
    plane_.is_flat = plane_.along[0].isZero(0) && plane_.along[1].isZero(0);
    if (plane_.is_flat) plane_.normal.normalize();
}

Vec3d SpecularSurface::Plane::mean_normal(const Vec3d& at) const {
    const Vec3d way = at - corner;
    return normal + gradient[0].dot(way) * along[0] + gradient[1].dot(way) * along[1];
}

Vec3d SpecularSurface::Plane::normal_change(const Vec3d& way) const {
    return gradient[0].dot(way) * along[0] + gradient[1].dot(way) * along[1];
}

SpecularSurface::Place SpecularSurface::on_exact(const Vec3d& on) const {
    const double side = shape_->flip_normals ? -1 : 1;
    const Vec3d across =
        side * (to_local_.linear().transpose() * exact_normal(*shape_, on)).normalized();
    return {on, to_world_ * on, across, across};
}

SpecularSurface::Place SpecularSurface::on_plane(const Vec3d& on) const {
    return {on, on, plane_.across,
            plane_.is_flat ? plane_.normal : plane_.mean_normal(on).normalized()};
}

SpecularSurface::Place SpecularSurface::beside(const Vec3d& local) const {
    if (shape_ != nullptr) return on_exact(exact_onto(*shape_, local));
    return on_plane(local - plane_.across.dot(local - plane_.corner) * plane_.across);
}

SpecularSurface::Change SpecularSurface::beside_change(const Vec3d& local, const Place& place,
                                                       const Vec3d& way) const {
    Change change;
    if (shape_ != nullptr)
        change.position = to_world_.linear() * exact_onto_change(*shape_, local, way);
    else
        change.position = way - plane_.across.dot(way) * plane_.across;
    change.normal = normal_change(place, change.position);
    return change;
}

Vec3d SpecularSurface::normal_change(const Place& place, const Vec3d& way) const {
    if (shape_ != nullptr) {
        const Eigen::Matrix3d turn = to_local_.linear().transpose();
        const Vec3d change = exact_normal_change(*shape_, place.local, local_way(way));
        const double side = shape_->flip_normals ? -1 : 1;
        return side * unit_change(turn * exact_normal(*shape_, place.local), turn * change);
    }
    if (plane_.is_flat) return Vec3d::Zero();
    return unit_change(plane_.mean_normal(place.local), plane_.normal_change(way));
}

std::optional<SpecularSurface::Place> SpecularSurface::first_along(const Vec3d& from,
                                                                   const Vec3d& direction,
                                                                   double least) const {
    if (shape_ != nullptr) {
        const auto hit = intersect_exact(*shape_, local(from), local_way(direction), least,
                                         std::numeric_limits<double>::infinity());
        if (!hit) return {};
        return on_exact(hit->local);
    }
    const double way = plane_.across.dot(plane_.corner - from) / plane_.across.dot(direction);
    if (!(way > least)) return {};
    return on_plane(from + way * direction);
}

}  // namespace caustics::beamtree

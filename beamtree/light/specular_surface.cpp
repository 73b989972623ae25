#include "beamtree/light/specular_surface.h"

#include "beamtree/beams/lit_caster.h"
#include "core/geometry/exact_shape.h"

namespace caustics::beamtree {
namespace {

// Of the lengths over which the surface changes: central differences err by its square.
constexpr double relative_step = 1e-5;

}  // namespace

SpecularSurface::SpecularSurface(const Shape& shape)
    : shape_(&shape),
      to_world_(shape.to_world),
      to_local_(shape.to_world.inverse()),
      step_(relative_step *
            ask_exact(shape, [](const auto& kind) { return kind.feature_size(); })) {}

std::optional<SpecularSurface> SpecularSurface::facet(const TriangleMesh& mesh,
                                                      std::uint32_t triangle) {
    const auto& [i, j, k] = mesh.triangles[triangle];
    const bool has_normals = !mesh.normals.empty();
    // First what tells nearly all smooth triangles: every hit asks.
    if (has_normals && (mesh.normals[j] != mesh.normals[i] || mesh.normals[k] != mesh.normals[i]))
        return {};
    const Vec3d a = mesh.positions[i].cast<double>();
    const Vec3d b = mesh.positions[j].cast<double>();
    const Vec3d c = mesh.positions[k].cast<double>();
    const Vec3d across = (b - a).cross(c - a).stableNormalized();
    if (!has_normals) return SpecularSurface(Plane{a, across, across});
    const Vec3& normal = mesh.normals[i];
    if (!is_flat_between(normal, across.cast<float>())) return {};
    return SpecularSurface(Plane{a, across, normal.cast<double>().normalized()});
}

Vec3d SpecularSurface::onto(const Vec3d& local) const {
    if (!plane_) return exact_onto(*shape_, local);
    return local - plane_->across.dot(local - plane_->point) * plane_->across;
}

Vec3d SpecularSurface::across(const Vec3d& on) const {
    return plane_ ? plane_->across : exact_normal(*shape_, on);
}

Vec3d SpecularSurface::normal(const Vec3d& on) const {
    if (plane_) return plane_->normal;
    const Vec3d normal = (to_local_.linear().transpose() * exact_normal(*shape_, on)).normalized();
    return shape_->flip_normals ? Vec3d(-normal) : normal;
}

SpecularSurface::Tangents SpecularSurface::tangents(const Vec3d& place,
                                                    const std::array<Vec3d, 2>& axes) const {
    Tangents found;
    for (std::size_t i = 0; i < 2; ++i) {
        if (plane_) {
            found.position[i] = axes[i] - plane_->across.dot(axes[i]) * plane_->across;
            found.normal[i] = Vec3d::Zero();
            continue;
        }
        const Vec3d before = onto(place - step_ * axes[i]);
        const Vec3d after = onto(place + step_ * axes[i]);
        found.position[i] = to_world_.linear() * (after - before) / (2 * step_);
        found.normal[i] = (normal(after) - normal(before)) / (2 * step_);
    }
    return found;
}

}  // namespace caustics::beamtree

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/geometry/shape.h"

namespace caustics::beamtree {

/// A surface that bends light, in double: an exact shape in its local frame, or the plane of a mesh's triangle in
/// the scene's frame, with the normals that the mesh interpolates. Light of a mesh goes by these normals, as it does
/// for every method.
class SpecularSurface {
public:
    /// A point of the surface.
    struct Place {
        Vec3d local;     ///< in the surface's frame
        Vec3d position;  ///< in the scene's frame
        Vec3d across;    ///< unit geometric normal, front side
        Vec3d normal;    ///< unit shading normal, front side
    };
    /// How a place and its shading normal change, per step of a coordinate, in the scene's frame.
    struct Change {
        Vec3d position;
        Vec3d normal;
    };

    /// The surface of an exact shape, which outlives this.
    explicit SpecularSurface(const Shape& exact);
    /// The plane of a triangle, which has area; the mesh outlives this.
    SpecularSurface(const TriangleMesh& mesh, std::uint32_t triangle);

    Vec3d local(const Vec3d& position) const { return to_local_ * position; }
    Vec3d world(const Vec3d& local) const { return to_world_ * local; }
    Vec3d local_way(const Vec3d& way) const { return to_local_.linear() * way; }
    /// The place beside a point near the surface, which is given in the surface's frame.
    Place beside(const Vec3d& local) const;
    /// How that place changes as the point moves along a way of the surface's frame.
    Change beside_change(const Vec3d& local, const Place& place, const Vec3d& way) const;
    /// True for a triangle that is shaded by one normal, and its geometric normal.
    bool is_flat_facet() const { return shape_ == nullptr && plane_.is_flat; }
    const Vec3d& facet_normal() const { return plane_.across; }
    /// How the shading normal at a place changes along a way on the surface, in the scene's frame.
    Vec3d normal_change(const Place& place, const Vec3d& way) const;
    /// The place where a ray first meets the surface beyond `least` [m]; on a triangle, its plane.
    std::optional<Place> first_along(const Vec3d& from, const Vec3d& direction, double least) const;

private:
    /// A triangle's plane, and the corners' normals by barycentric coordinates: at a + u (b - a) + v (c - a) the
    /// shading normal goes along normal + u along_u + v along_v.
    struct Plane {
        Vec3d corner;
        Vec3d across;
        std::array<Vec3d, 2> gradient;  ///< of the barycentric coordinates [1/m]
        Vec3d normal;
        std::array<Vec3d, 2> along;
        bool is_flat = false;  ///< shaded by one normal

        Vec3d mean_normal(const Vec3d& at) const;
        Vec3d normal_change(const Vec3d& way) const;
    };
    Place on_exact(const Vec3d& on) const;
    Place on_plane(const Vec3d& on) const;

    const Shape* shape_ = nullptr;  ///< where there is no plane
    Plane plane_;
    Transform to_world_ = Transform::Identity();
    Transform to_local_ = Transform::Identity();
};

}  // namespace caustics::beamtree

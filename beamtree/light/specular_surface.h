#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/geometry/shape.h"

namespace caustics::beamtree {

/// A surface that is known to rounding where it bends light, in a frame of its own: an exact shape in its local
/// frame, or the plane of a mesh's flat triangle in the world's.
class SpecularSurface {
public:
    /// The first derivatives of place and unit normal, in the world, by two coordinates of the frame.
    struct Tangents {
        std::array<Vec3d, 2> position;
        std::array<Vec3d, 2> normal;
    };

    /// Of an exact shape, which outlives this.
    explicit SpecularSurface(const Shape& shape);
    /// Of a triangle with area; empty where it is not flat: the normals of its corners differ from each other,
    /// or visibly from the triangle's.
    static std::optional<SpecularSurface> facet(const TriangleMesh& mesh, std::uint32_t triangle);

    Vec3d world(const Vec3d& local) const { return to_world_ * local; }
    Vec3d local(const Vec3d& world) const { return to_local_ * world; }
    /// The point of the surface beside one near it.
    Vec3d onto(const Vec3d& local) const;
    /// Unit, in the frame, across the surface at one of its points.
    Vec3d across(const Vec3d& on) const;
    /// Unit, in the world, of the front side: bends the light.
    Vec3d normal(const Vec3d& on) const;
    /// Beside the place, by the way along two axes.
    Tangents tangents(const Vec3d& place, const std::array<Vec3d, 2>& axes) const;

private:
    /// A plane, and the normal that its mesh gives it.
    struct Plane {
        Vec3d point;
        Vec3d across;
        Vec3d normal;
    };
    explicit SpecularSurface(const Plane& plane) : plane_(plane) {}

    const Shape* shape_ = nullptr;  ///< where there is no plane
    std::optional<Plane> plane_;
    Transform to_world_ = Transform::Identity();
    Transform to_local_ = Transform::Identity();
    double step_ = 0;  ///< of differences over an exact shape
};

}  // namespace caustics::beamtree

#pragma once

#include "beamtree/beams/beam.h"
#include "beamtree/light/test_plane.h"

namespace caustics::beamtree {

/// Rays flatter than this to the plane count as going along it.
inline constexpr double least_steepness = 1e-4;

/// A ray as the plane sees it.
struct RayOnPlane {
    const VertexRay* ray;
    double height;
    double steepness;
    Vec2d at;  ///< where it meets the plane, from the point; only of rays that come down

    bool comes_down() const { return height > 0 && steepness > least_steepness; }
};

inline RayOnPlane on_plane(const VertexRay& ray, const TestPlane& plane) {
    RayOnPlane found{&ray, plane.height(ray.position), plane.steepness(ray.direction),
                     Vec2d::Zero()};
    if (found.comes_down())
        found.at = plane.project(ray.position, found.height / found.steepness, ray.direction);
    return found;
}

/// The signed crossing of the edge a -> b with the half axis y = 0, x > 0; summed round a polygon it
/// is the winding round the origin. Without branches, which would be mispredicted.
inline int edge_crossing(const Vec2d& a, const Vec2d& b) {
    const bool a_above = a.y() > 0;
    const bool b_above = b.y() > 0;
    const double side = cross(a, b);
    const bool up = !a_above & b_above & (side > 0);
    const bool down = a_above & !b_above & (side < 0);
    return static_cast<int>(up) - static_cast<int>(down);
}

/// A triangle of a beam projected on the plane.
struct Projected {
    int winding = 0;
    double area = 0;  ///< signed, in the two coordinates
    Vec3d weights = Vec3d::Zero();
    double share = 1;  ///< of the triangle that is not clipped away

    bool is_hit() const { return winding != 0 && area != 0; }
};

/// A triangle by its corners on the plane.
inline Projected projected(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    Projected found;
    found.winding = edge_crossing(a, b) + edge_crossing(b, c) + edge_crossing(c, a);
    found.area = cross(b - a, c - a) / 2;
    if (found.winding != 0)
        found.weights = Vec3d(cross(b, c), cross(c, a), cross(a, b)) / (2 * found.area);
    return found;
}

}  // namespace caustics::beamtree

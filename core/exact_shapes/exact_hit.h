#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// The first point of an exact shape along a ray, in the shape's local frame, solved in double.
struct ExactHit {
    double distance;  ///< ray parameter, the same in the local and the world frame
    Vec3d local;      ///< the point, on the shape to rounding
};

/// Ray parameters between two, both left out.
struct RayInterval {
    double low, high;
    bool holds(double t) const { return t > low && t < high; }
};

/// The plane z = 0.
std::optional<ExactHit> hit_of_plane(const Vec3d& o, const Vec3d& d, RayInterval range);

/// Roots of a t^2 + 2 b t + c without cancellation, ascending; empty when not real.
std::optional<std::pair<double, double>> quadratic_roots(double a, double b, double c,
                                                         double discriminant);

/// Angle of (x, y) about the origin [turns, 0 .. 1].
double turns_of(const Vec2d& xy);
/// The unit vector at an angle [turns], and how it changes.
Vec3d at_turns(double turns);
Vec3d along_turns(double turns);

/// Corners of the prism round a sector [rad] of the unit disc's rim or, from radius r0 on, of its area.
std::vector<Vec3d> sector_hull(double from, double to, double r0, double height);

}  // namespace caustics

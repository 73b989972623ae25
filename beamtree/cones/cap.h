#pragma once

#include <span>

#include "core/math/vec.h"

namespace caustics::beamtree {

/// Unit vectors within an angle of an axis, by the cosine of that angle. A cap of less than a right
/// angle is convex: what holds the vertex rays of a beam holds every positive combination of them.
struct Cap {
    Vec3d axis = Vec3d::UnitZ();
    double cosine = -1;  ///< -1: all directions

    double sine() const;
    double angle() const;
    /// Wider than a right angle: bounds nothing.
    bool is_wide() const { return cosine <= 0; }
};

/// The cap of [CC95 fig. 4]: its axis points to the centre of the box round the unit vectors, its
/// angle is the largest to any of them. Two to five per cent wider than need be.
Cap box_cap(std::span<const Vec3d> directions);

/// The smallest cap [CC95 (1)], by Welzl's incremental method on the sphere. Directions that
/// hardly fit into a hemisphere get that of their box.
Cap smallest_cap(std::span<const Vec3d> directions);

/// A circle of a plane.
struct Circle {
    Vec2d centre = Vec2d::Zero();
    double radius = 0;
};

/// The minimum spanning circle [Welzl 1991; Toussaint 1985 in CC95].
Circle smallest_circle(std::span<const Vec2d> points);

}  // namespace caustics::beamtree

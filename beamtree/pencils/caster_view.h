#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "core/geometry/shape.h"
#include "core/math/vec.h"

namespace caustics::beamtree {

using BoxCorners = std::array<Vec3d, 8>;

/// Bounds that hold a caster both: the corners of a box, and a ball about the box's middle.
struct CasterBounds {
    BoxCorners corners = {};
    double radius = 0;

    Vec3d middle() const { return (corners[0] + corners[7]) / 2; }
};
CasterBounds caster_bounds(const Shape& shape);

/// A rectangle along two unit directions of a plane, in coordinates of a point of the plane.
struct PlaneRectangle {
    std::array<Vec3d, 2> axes;
    Vec2d low = Vec2d::Constant(std::numeric_limits<double>::infinity());
    Vec2d high = -low;

    void add(const Vec2d& point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    Vec2d size() const { return high - low; }
    double area() const { return size().prod(); }
    /// A little larger, for rounding.
    void widen();
};

/// The rectangle across a unit normal that holds points, turned by an angle from the normal's frame.
PlaneRectangle rectangle_round(const BoxCorners& points, const Vec3d& normal, double angle);
/// The angle of several with which it is smallest.
double best_turn(const BoxCorners& points, const Vec3d& normal);

/// The corners on the plane across an axis at a distance of 1 from a place; empty where one lies far off the axis.
std::optional<BoxCorners> seen_round(const Vec3d& from, const Vec3d& axis,
                                     const BoxCorners& corners);

/// A rectangle in space: corner + x * sides[0] + y * sides[1], with x and y from 0 to 1.
struct ViewRectangle {
    Vec3d corner = Vec3d::Zero();
    std::array<Vec3d, 2> sides = {Vec3d::Zero(), Vec3d::Zero()};

    Vec3d at(double x, double y) const { return corner + x * sides[0] + y * sides[1]; }
    double area() const { return sides[0].cross(sides[1]).norm(); }
};
ViewRectangle in_space(const PlaneRectangle& rectangle, const Vec3d& origin);

/// Rectangles that hold all rays from a place to a caster, each once: one, or where the caster is near those faces of a cube round the
/// place that see something of its box.
struct CasterView {
    std::array<ViewRectangle, 6> rectangles;
    std::size_t count = 0;
};
/// `angle` is the turn of the rectangle where one will do; without it the best is looked for.
CasterView caster_view(const Vec3d& from, const CasterBounds& caster,
                       std::optional<double> angle = {});

}  // namespace caustics::beamtree

#pragma once

#include <array>
#include <cmath>

#include "core/math/plane_axes.h"

namespace caustics {

/// Where irradiance is averaged instead of being asked at a receiver point, on its tangent plane: the part of a picture
/// that one camera sample stands for, as the camera sees it there, a convex quadrilateral (a pixel's cells cover it
/// once), or a square round the point.
struct PixelCell {
    Vec3d normal;    ///< of the plane, on the camera's side; unit to rounding
    PlaneAxes axes;  ///< of the plane; coordinates along them are from the receiver point [m]
    std::array<Vec2d, 4> corners;  ///< in order round it
    double radius = 0;             ///< distance of the farthest one
    /// By which share of the point's depth [1/m] the camera's depth grows along the axes.
    Vec2d depth_slope = Vec2d::Zero();

    /// Along PlaneAxes.
    static PixelCell square(const Vec3d& normal, double side) {
        const double half = side / 2;
        return {.normal = normal,
                .axes = PlaneAxes(normal),
                .corners = {Vec2d(-half, -half), Vec2d(half, -half), Vec2d(half, half),
                            Vec2d(-half, half)},
                .radius = std::sqrt(2.0) * half};
    }

    /// The parallelogram through the middles of a cell's sides: it has the cell's area, and those of neighbours
    /// overlap by the second order of their size only.
    struct Sides {
        Vec2d middle, first, second;
        double sine;  ///< of the angle between the two; 0 without area
    };
    Sides sides() const {
        const Vec2d first = (corners[1] + corners[2] - corners[0] - corners[3]) / 2;
        const Vec2d second = (corners[2] + corners[3] - corners[0] - corners[1]) / 2;
        const double turn = std::abs(first.x() * second.y() - first.y() * second.x());
        const double product = first.norm() * second.norm();
        return {(corners[0] + corners[1] + corners[2] + corners[3]) / 4, first, second,
                product > 0 ? turn / product : 0};
    }

    Vec2d along(const Vec3d& way) const { return {axes.right.dot(way), axes.forward.dot(way)}; }
    /// From the receiver point [m].
    Vec3d at(const Vec2d& p) const { return p.x() * axes.right + p.y() * axes.forward; }
    Vec3d corner(std::size_t i) const { return at(corners[i]); }
    /// Where the camera shows a place of the plane, but for an affine map: straight lines stay so, and areas are in the
    /// ratios that they have in the picture.
    Vec2d on_film(const Vec2d& p) const { return p / (1 + depth_slope.dot(p)); }
};

}  // namespace caustics

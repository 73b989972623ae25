#pragma once

#include "core/math/vec.h"

namespace caustics {

/// Two unit axes of the planes across a normal: along the axis of the world that lies best on them, since grids
/// and pixels mostly run along one, and across it. The squares of `footprint` lie along them.
struct PlaneAxes {
    Vec3d right, forward;

    /// `normal`: unit, but for rounding.
    explicit PlaneAxes(const Vec3d& normal) {
        Eigen::Index flattest = 0;
        normal.cwiseAbs().minCoeff(&flattest);
        const Vec3d axis = Vec3d::Unit(flattest);
        right = (axis - axis.dot(normal) / normal.squaredNorm() * normal).normalized();
        forward = normal.cross(right).normalized();
    }
};

}  // namespace caustics

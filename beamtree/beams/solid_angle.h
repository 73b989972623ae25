#pragma once

#include <cmath>

#include "core/math/vec.h"

namespace caustics::beamtree {

/// Solid angle of a triangle from the vectors to its corners [sr; Van Oosterom and Strackee 1983]:
/// positive where u, v, w turn to the right as they are seen, which is the back of the triangle.
inline double solid_angle(const Vec3d& u, const Vec3d& v, const Vec3d& w) {
    const double lu = u.norm();
    const double lv = v.norm();
    const double lw = w.norm();
    // From edges: cancels less for a small triangle far away.
    const double determinant = u.dot((v - u).cross(w - u));
    return 2 *
           std::atan2(determinant, lu * lv * lw + u.dot(v) * lw + u.dot(w) * lv + v.dot(w) * lu);
}

}  // namespace caustics::beamtree

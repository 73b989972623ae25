#pragma once

#include "core/math/vec.h"

namespace caustics {

/// The one offset rule: how far off its surface a ray starts that leaves a point [m]. It covers the
/// rounding at that point and nothing else, so that it never grows with what lies elsewhere.

/// Twice the spacing of floats at the largest coordinate: the position, rounded to float, is at most
/// 0.87 spacings off the surface, and so is the sum of position and offset.
inline float rounding_offset(const Vec3& position) {
    return 0x1p-22F * position.cwiseAbs().maxCoeff();
}

/// Of a point in a triangle with this unit normal. Embree finds the triangle's plane from its corners
/// relative to the ray's origin, in float: that plane is off by some roundings of those differences,
/// as far as they count along the normal.
inline float triangle_offset(const Vec3& position, const Vec3& normal, const Vec3& a, const Vec3& b,
                             const Vec3& c) {
    const Vec3 reach = (a - position)
                           .cwiseAbs()
                           .cwiseMax((b - position).cwiseAbs())
                           .cwiseMax((c - position).cwiseAbs());
    return rounding_offset(position) + 0x1p-20F * normal.cwiseAbs().dot(reach);
}

}  // namespace caustics

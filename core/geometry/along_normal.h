#pragma once

#include "core/math/vec.h"

namespace caustics {

/// The cross product of two edges of a triangle. Where the square of the triangle's area is no normal float, its
/// direction alone, about 1 long; zero for edges that are exactly parallel.
inline Vec3 along_normal(const Vec3& u, const Vec3& v) {
    const Vec3 cross = u.cross(v);
    const float largest = cross.cwiseAbs().maxCoeff();
    if (largest > 0x1p-60F && largest < 0x1p60F) return cross;
    const Vec3d exact = u.cast<double>().cross(v.cast<double>());
    const double size = exact.cwiseAbs().maxCoeff();
    return size > 0 ? Vec3((exact / size).cast<float>()) : Vec3(Vec3::Zero());
}

}  // namespace caustics

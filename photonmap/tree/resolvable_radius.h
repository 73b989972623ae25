#pragma once

#include <algorithm>
#include <limits>

#include "core/math/vec.h"

namespace caustics::photonmap {

/// Radius [m] below which distances between float positions mean nothing. Where N photons
/// fall into one point, at a perfect focus, their density has no finite value; over this disc it
/// is large, and finite.
inline float resolvable_radius(const Vec3& point, float max_radius) {
    return std::numeric_limits<float>::epsilon() *
           std::max(point.cwiseAbs().maxCoeff(), max_radius);
}

}  // namespace caustics::photonmap

#pragma once

#include <algorithm>
#include <limits>

#include "core/math/vec.h"

namespace caustics::beamtree {

/// The smallest area of an image at a point [m^2]: areas between float positions mean nothing below it. At a perfect
/// focus, where an image shrinks to a point, the irradiance is large with it, and finite.
inline double resolvable_area(const Vec3& point) {
    const double side = static_cast<double>(std::numeric_limits<float>::epsilon() *
                                            std::max(point.cwiseAbs().maxCoeff(), 1e-6F));
    return side * side;
}

}  // namespace caustics::beamtree

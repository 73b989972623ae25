#pragma once

#include "core/math/vec.h"

namespace caustics {

/// Of every coordinate and length that is read [m]. Embree takes no ray that starts beyond 1.844e18 in
/// any coordinate; directional light starts outside of the scene's bounds, as far as 3.2 times their
/// farthest coordinate.
inline constexpr double farthest_coordinate = 5e17;

/// Whether all coordinates are numbers within the limit.
template <typename Derived>
bool within_limit(const Eigen::MatrixBase<Derived>& point) {
    return point.allFinite() &&
           static_cast<double>(point.cwiseAbs().maxCoeff()) <= farthest_coordinate;
}

}  // namespace caustics

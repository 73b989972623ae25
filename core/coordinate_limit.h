#pragma once

#include "core/vec.h"

namespace caustics {

/// Of every coordinate and length that is read [m]: Embree takes rays from nowhere beyond 1.844e18
/// in any coordinate, and light starts outside of the scene's bounds.
inline constexpr double farthest_coordinate = 1e18;

/// Whether all coordinates are numbers within the limit.
template <typename Derived>
bool within_limit(const Eigen::MatrixBase<Derived>& point) {
    return point.allFinite() &&
           static_cast<double>(point.cwiseAbs().maxCoeff()) <= farthest_coordinate;
}

}  // namespace caustics

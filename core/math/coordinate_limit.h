#pragma once

#include "core/math/vec.h"

namespace caustics {

/// Of every coordinate and length that is read [m]. Embree takes no ray that starts beyond 1.844e18 in
/// any coordinate; directional light starts outside of the scene's bounds, as far as 3.2 times their
/// farthest coordinate.
inline constexpr double farthest_coordinate = 5e17;

/// The least width of an exact shape [m]: squares of areas of the polygons that beams take for it are still floats.
inline constexpr double smallest_size = 1e-10;

/// Of meshes [m]. Embree gives no place within triangles of less than about 1e-18 m^2, which here are a hundredth of
/// the mesh wide at most, and multiplies three differences of coordinates in float.
inline constexpr double smallest_mesh = 1e-7;
inline constexpr double farthest_vertex = 1e12;

/// Of angles in either direction, in any unit: a double resolves these to 1e-10 of it.
inline constexpr double most_turned = 1e6;

/// Whether all coordinates are numbers within the limit.
template <typename Derived>
bool within_limit(const Eigen::MatrixBase<Derived>& point) {
    return point.allFinite() &&
           static_cast<double>(point.cwiseAbs().maxCoeff()) <= farthest_coordinate;
}

}  // namespace caustics

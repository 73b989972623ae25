#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// A ray of light that has gone through a specular surface to the floor.
struct LandedRay {
    Vec2d floor;       ///< where it lands [m]
    double power = 0;  ///< of the light per area of the two parameters [W]
};

/// A ray by two parameters of the first specular surface, each from 0 to 1. Empty where no light lands.
using RayMap = std::function<std::optional<LandedRay>(const Vec2d&)>;

/// All rays of a map that reach a point of the floor.
struct LightAtPoint {
    std::size_t rays = 0;
    double irradiance = 0;  ///< [W/m^2]
    /// The least of the rays' |determinants| over the size of their derivatives squared: small beside a fold.
    double distinctness = 1;
};

/// Finds the rays by Newton's method from each of side x side places whose neighbours' landings surround the point,
/// widened by their size. It shares no code with the beams.
std::vector<LightAtPoint> brute_force_light(const std::vector<RayMap>& maps, int side,
                                            const std::vector<Vec2d>& floor);

}  // namespace caustics

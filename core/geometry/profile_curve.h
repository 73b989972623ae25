#pragma once

#include <vector>

#include "core/geometry/lathe.h"

namespace caustics {

/// A point of the curve that a lathe's profile describes, in its order.
struct ProfileStation {
    Vec2d at;             ///< (r, z) [m]
    Vec2d normal_before;  ///< unit, (dz, -dr) of the way that comes here; differs at a crease
    Vec2d normal_after;   ///< of the way that goes on
    double v;             ///< share of the curve's length, 0 .. 1
};

/// Throws InputError as tessellate_lathe (lathe.h) says.
std::vector<ProfileStation> profile_stations(const LatheProfile& profile);

}  // namespace caustics

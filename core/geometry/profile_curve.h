#pragma once

#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// A point of a lathe's profile.
struct ProfilePoint {
    Vec2d at = Vec2d::Zero();  ///< (r, z) [m], r >= 0 off the axis z
    bool crease = false;       ///< the surface has an edge here
};

/// A curve in the half-plane (r, z) that turns round the axis z. It is open where it ends off the
/// axis; one whose last point is its first is a ring and has no ends.
struct LatheProfile {
    std::vector<ProfilePoint> points;
    /// Centripetal Catmull-Rom curves from crease to crease [Yuksel et al. 2011], in place of
    /// straight lines. Either is mirrored by the axis where it meets it, but for straight lines that meet it aslant:
    /// the tip of a cone is a crease, whatever its point says.
    bool catmull_rom = false;
    int segments = 1;   ///< straight pieces between two points
    bool open = false;  ///< may have ends off the axis
};

/// A point of the curve that a lathe's profile describes, in its order.
struct ProfileStation {
    Vec2d at;             ///< (r, z) [m]
    Vec2d normal_before;  ///< unit, (dz, -dr) of the way that comes here; differs at a crease
    Vec2d normal_after;   ///< of the way that follows
    double v;             ///< share of the curve's length, 0 .. 1
};

/// Throws InputError as tessellate_lathe (lathe.h) says.
std::vector<ProfileStation> profile_stations(const LatheProfile& profile);

}  // namespace caustics

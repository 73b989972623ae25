#pragma once

#include <vector>

#include "core/geometry/mesh.h"

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
    /// straight lines. Either is mirrored by the axis where it meets it.
    bool catmull_rom = false;
    int segments = 1;   ///< straight pieces between two points
    bool open = false;  ///< may have ends off the axis
};

/// The surface with `sectors` >= 3 round the axis, whose front is on the right of the profile's way:
/// an outer profile runs upwards. Normals are those of the curve, or of the circle through a point
/// and its neighbours for straight lines, so that these shade smoothly too; a crease has one for
/// each side. uv: u round the axis, v along the profile. The bands are one GridPatch, and a fan at
/// each pole. Where two lathes have one r and z and as many sectors, their vertices agree bit for bit.
/// Throws InputError, naming the points, for a profile that meets itself or the axis between its
/// ends, that ends off the axis unless `open`, or that is too large.
TriangleMesh tessellate_lathe(const LatheProfile& profile, int sectors);

}  // namespace caustics

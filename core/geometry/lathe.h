#pragma once

#include "core/geometry/profile_curve.h"
#include "core/mesh/mesh.h"

namespace caustics {

/// The surface with `sectors` >= 3 round the axis, whose front is on the right of the profile's way:
/// an outer profile runs upwards. Normals are those of the curve, or of the circle through a point
/// and its neighbours for straight lines, so that these shade smoothly too; a crease has one for
/// each side. uv: u round the axis, v along the profile. The bands are one GridPatch, and a fan at
/// each pole. Where two lathes have one r and z and as many sectors, their vertices agree bit for bit.
/// Throws InputError, naming the points, for a profile that meets itself or the axis between its
/// ends, that ends off the axis unless `open`, or that is too large.
TriangleMesh tessellate_lathe(const LatheProfile& profile, int sectors);

}  // namespace caustics

#pragma once

#include "core/geometry/ray.h"

namespace caustics {

/// An end of a line of sight: a free point (offset 0), or a point on a surface.
struct SegmentEnd {
    Vec3 position = Vec3::Zero();
    Vec3 geometric_normal = Vec3::Zero();  ///< unit, either side
    float offset = 0;                      ///< of that surface [m]
};

/// Signed distance along a unit direction from a point to where light from that direction begins: just
/// outside of the bounds of all surfaces [m]. Measured along the line itself, so that a wide floor
/// sends no light off to start where floats are coarse. A line that misses the bounds begins anywhere.
float distance_to_entry(const Box& bounds, const Vec3& point, const Vec3& direction);

/// A surface point moved off its surface to the side that `direction` points to.
Vec3 offset_origin(const SegmentEnd& end, const Vec3& direction);

/// The ray from one end to just before another; its max_distance is 0 where they are one place.
Ray segment_between(const SegmentEnd& from, const SegmentEnd& to);

/// A ray that leaves an end along a unit direction without meeting its surface again.
Ray spawn_ray(const SegmentEnd& end, const Vec3& direction);

}  // namespace caustics

#include "core/geometry/segment.h"

#include <algorithm>
#include <limits>

namespace caustics {

// Along a line that is nearly parallel to a side, and beside it, the plane of the side is met far beyond the
// bounds, or beyond all floats: a ball round the bounds is the end.
float distance_to_entry(const Box& bounds, const Vec3& point, const Vec3& direction) {
    // Outwards by more than the rounding of the bounds, of a flat scene as well.
    const Vec3 low = bounds.min() - Vec3::Constant(0x1p-20F * bounds.min().cwiseAbs().maxCoeff());
    const Vec3 high = bounds.max() + Vec3::Constant(0x1p-20F * bounds.max().cwiseAbs().maxCoeff());
    float entry = -std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const float face = direction[axis] > 0 ? low[axis] : high[axis];
        entry = std::max(entry, (face - point[axis]) / direction[axis]);
    }
    const float nearest = ((low + high) / 2 - point).dot(direction);
    const float radius = 0.5F * (1 + 0x1p-10F) * (high - low).norm();
    return std::clamp(entry, nearest - radius, nearest + radius);
}

Vec3 offset_origin(const SegmentEnd& end, const Vec3& direction) {
    const float side = end.geometric_normal.dot(direction) < 0 ? -end.offset : end.offset;
    return end.position + side * end.geometric_normal;
}

Ray segment_between(const SegmentEnd& from, const SegmentEnd& to) {
    const Vec3 towards = to.position - from.position;
    Ray ray;
    ray.origin = offset_origin(from, towards);
    const Vec3 segment = offset_origin(to, -towards) - ray.origin;
    const float distance = segment.norm();
    // The far end is found from here, to some roundings of the distance: ending before it by more than
    // those, the ray does not meet the surface that it goes to.
    ray.max_distance = distance * (1 - 0x1p-19F);
    if (distance > 0) ray.direction = segment / distance;
    return ray;
}

Ray spawn_ray(const SegmentEnd& end, const Vec3& direction) {
    Ray ray;
    ray.origin = offset_origin(end, direction);
    ray.direction = direction;
    return ray;
}

}  // namespace caustics

#include "beamtree/slices/slice_frame.h"

namespace caustics::beamtree {

SliceFrame::SliceFrame(const Vec3& normal, double top, double bottom, const Vec3& origin)
    : normal_(normal),
      up_(normal.cast<double>()),
      axes_(up_),
      origin_(origin.cast<double>()),
      top_(top),
      bottom_(bottom) {}

RaySlices SliceFrame::slices(const VertexRay& ray) const {
    const Vec3d from = ray.position.cast<double>();
    const Vec3d along = ray.direction.cast<double>();
    const double height = up_.dot(from);
    const double steepness = -up_.dot(along);
    const Vec2d above = across(from + (height - top_) / steepness * along);
    const Vec2d below = across(from + (height - bottom_) / steepness * along);
    return {static_cast<float>(above.x()), static_cast<float>(above.y()),
            static_cast<float>(below.x()), static_cast<float>(below.y())};
}

}  // namespace caustics::beamtree

#pragma once

#include <array>

#include "beamtree/beams/beam.h"
#include "core/math/plane_axes.h"
#include "core/math/vec.h"

namespace caustics::beamtree {

/// Where a ray, as a line, meets the upper and the lower plane of a slab: (x, y) above, (x, y)
/// below, in the frame's coordinates [m].
using RaySlices = std::array<float, 4>;

/// A slab of space between two planes across a fixed normal, and coordinates in it. Points of a ray
/// that comes down through the slab are linear in the share of the way down.
class SliceFrame {
public:
    /// `normal` points up, against the light; planes at heights `top` > `bottom`, heights measured
    /// by the normal as it is. `origin`: a point in the middle of things, where floats are finest.
    SliceFrame(const Vec3& normal, double top, double bottom, const Vec3& origin);

    const Vec3& normal() const { return normal_; }
    double top() const { return top_; }
    double bottom() const { return bottom_; }
    double height(const Vec3& p) const { return up_.dot(p.cast<double>()); }
    /// Of the way from the upper plane to the lower one: 0 to 1.
    double share(double height) const { return (top_ - height) / (top_ - bottom_); }
    /// Of a point on the plane at its own height.
    Vec2d across(const Vec3d& p) const {
        return {axes_.right.dot(p - origin_), axes_.forward.dot(p - origin_)};
    }
    /// Of a way from one point to another.
    Vec2d along(const Vec3d& way) const { return {axes_.right.dot(way), axes_.forward.dot(way)}; }
    double rise(const Vec3d& way) const { return up_.dot(way); }
    /// The ray must come down.
    RaySlices slices(const VertexRay& ray) const;

private:
    Vec3 normal_;
    Vec3d up_;
    PlaneAxes axes_;
    Vec3d origin_;
    double top_;
    double bottom_;
};

}  // namespace caustics::beamtree

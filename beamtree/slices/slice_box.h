#pragma once

#include <array>
#include <limits>

#include "beamtree/slices/slice_frame.h"

namespace caustics::beamtree {

/// How far beside a ray there may be light, to either side [m]: along (x, y) above and (x, y) below, as RaySlices.
using SliceReach = std::array<float, 4>;

/// The two boxes, on both planes of a slab, that hold some rays there; interpolated between the
/// planes they hold them at every height, because the least of linear functions is concave.
class SliceBox {
public:
    void extend(const RaySlices& ray, const SliceReach& reach = {}) {
        const Half at = Eigen::Map<const Half>(ray.data());
        const Half far = Eigen::Map<const Half>(reach.data());
        bounds_ << bounds_.head<4>().min(at - far), bounds_.tail<4>().min(-at - far);
    }
    void extend(const SliceBox& other) { bounds_ = bounds_.min(other.bounds_); }

    /// Along an axis (0, 1) of the upper plane (0) or the lower one (1).
    float low(int axis, int plane) const { return bounds_[2 * plane + axis]; }
    float high(int axis, int plane) const { return -bounds_[4 + 2 * plane + axis]; }
    float size(int axis, int plane) const { return high(axis, plane) - low(axis, plane); }
    /// Twice the centres of both boxes.
    Eigen::Array4f key() const { return bounds_.head<4>() - bounds_.tail<4>(); }
    /// Mean area of the interpolated box on the planes and half way between them, times 12: in
    /// proportion to the chance that a point at one of these heights lies inside.
    float area() const {
        const Half size = -(bounds_.head<4>() + bounds_.tail<4>());
        return 4 * (size[0] * size[1] + size[2] * size[3]) +
               (size[0] + size[2]) * (size[1] + size[3]);
    }

private:
    using Half = Eigen::Array4f;
    /// Least values (x, y above; x, y below), then greatest ones with their signs turned.
    Eigen::Array<float, 8, 1> bounds_ =
        Eigen::Array<float, 8, 1>::Constant(std::numeric_limits<float>::infinity());
};

}  // namespace caustics::beamtree

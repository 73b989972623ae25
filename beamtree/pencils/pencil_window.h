#pragma once

#include <array>
#include <cstddef>

#include "core/receiver_point.h"

namespace caustics::beamtree {

/// Where a query asks pencils: at a point, or over its cell.
class PencilWindow {
public:
    explicit PencilWindow(const ReceiverPoint& point);

    /// Distance from the point within which it lies [m]; 0 for a point.
    float radius() const { return radius_; }
    bool may_touch(const Box& box) const {
        return radius_ > 0 ? box.squaredExteriorDistance(position_) <= radius_ * radius_
                           : box.contains(position_);
    }
    /// The light of a pencil that falls on the window, over the pencil's light and the window's area [1/m^2]. The pencil has
    /// `area` across its rays, `at` are the point's numbers along its sides, `by_side` makes such numbers of ways, and `cosine` is
    /// that of the point's normal and the rays.
    double density(const Vec2& at, const std::array<Vec3, 2>& by_side, double area,
                   double cosine) const;

private:
    Vec3 position_;
    float radius_ = 0;
    std::array<Vec3, 4> corners_;  ///< from the position
    double area_ = 0;              ///< [m^2]
};

}  // namespace caustics::beamtree

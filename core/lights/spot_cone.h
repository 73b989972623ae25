#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/vec.h"

namespace caustics {

/// What makes a point light a spot light, as Mitsuba's `spot`: its intensity falls from the whole within
/// `beam_width` of the axis, linearly in the angle, to nothing at `cutoff`. Half angles [rad],
/// 0 <= beam_width <= cutoff < pi. A light of intensity I sends
/// 2 pi I (1 - (sin c - sin b) / (c - b)) in all [W], c and b being cutoff and beam width.
struct SpotCone {
    Vec3 axis = Vec3::UnitZ();  ///< unit, the way the light goes
    float beam_width = 0;
    float cutoff = std::numbers::pi_v<float> / 9;

    /// Of a direction from the axis [rad].
    float angle_to(const Vec3& direction) const {
        return std::atan2(axis.cross(direction).norm(), axis.dot(direction));
    }
    /// The share of the intensity that goes along a direction.
    float falloff(const Vec3& direction) const {
        const float angle = angle_to(direction);
        if (angle <= beam_width) return 1;
        return std::max(0.0F, (cutoff - angle) / std::max(cutoff - beam_width, 1e-6F));
    }
};

}  // namespace caustics

#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/vec.h"

namespace caustics {

/// Maps of the unit square; u0, u1 uniform in [0, 1).

/// Cosine-weighted direction about +z, pdf_w = cos / pi.
inline Vec3 cosine_hemisphere(float u0, float u1) {
    const float r = std::sqrt(u0);
    const float angle = 2 * pi * u1;
    return {r * std::cos(angle), r * std::sin(angle), std::sqrt(std::max(0.0F, 1 - u0))};
}

/// Uniform direction within `cos_angle` of +z, pdf_w = 1 / cone_solid_angle.
inline Vec3 uniform_cone(float cos_angle, float u0, float u1) {
    // 1 - z in double-free form keeps narrow cones exact where z itself rounds to 1.
    const float height = (1 - cos_angle) * u0;
    const float sine = std::sqrt(height * (2 - height));
    const float angle = 2 * pi * u1;
    return {sine * std::cos(angle), sine * std::sin(angle), 1 - height};
}

/// [sr]
inline double cone_solid_angle(float cos_angle) {
    return 2 * pi_d * (1 - static_cast<double>(cos_angle));
}

/// Uniform point of the unit disc.
inline Vec2 uniform_disc(float u0, float u1) {
    const float r = std::sqrt(u0);
    const float angle = 2 * pi * u1;
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// The first index whose cumulative share exceeds u; `cumulative` ascends to 1.
inline std::size_t pick(const std::vector<double>& cumulative, float u) {
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), static_cast<double>(u));
    return std::min(static_cast<std::size_t>(at - cumulative.begin()), cumulative.size() - 1);
}

}  // namespace caustics

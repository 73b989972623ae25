#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/frame.h"
#include "core/math/vec.h"
#include "core/math/warp.h"

namespace caustics {

/// Maps of the unit square; u0, u1 uniform in [0, 1).

/// Cosine-weighted direction about +z, pdf_w = cos / pi.
inline Vec3 cosine_hemisphere(float u0, float u1) {
    const float r = std::sqrt(u0);
    const float angle = 2 * pi * u1;
    return {r * std::cos(angle), r * std::sin(angle), std::sqrt(std::max(0.0F, 1 - u0))};
}

/// Uniform direction within an angle of +z, given as 1 - cos (2 = the whole sphere), pdf_w = 1 over
/// the solid angle 2 pi (1 - cos).
inline Vec3 uniform_cap(float one_minus_cos, float u0, float u1) {
    const float height = one_minus_cos * u0;
    const float sine = std::sqrt(height * (2 - height));
    const float angle = 2 * pi * u1;
    return {sine * std::cos(angle), sine * std::sin(angle), 1 - height};
}

/// The directions within an angle of a unit axis. The angle is kept as 1 - cos, which still resolves
/// narrow cones apart where cos itself rounds to 1 (below 3e-4 rad in float).
struct DirectionCone {
    Vec3 axis = Vec3::UnitZ();
    float one_minus_cos = 2;

    /// By the sine of an angle below a right one.
    static DirectionCone from_sine(const Vec3& axis, float sine) {
        return {axis, sine * sine / (1 + std::sqrt(1 - sine * sine))};
    }
    bool is_whole_sphere() const { return one_minus_cos >= 2; }
    double solid_angle() const { return 2 * pi_d * static_cast<double>(one_minus_cos); }  ///< [sr]
    float angle() const { return 2 * std::asin(std::sqrt(std::min(1.0F, one_minus_cos / 2))); }
    bool contains(const Vec3& w) const {
        return is_whole_sphere() || (w - axis).squaredNorm() <= 2 * one_minus_cos;
    }
    /// Uniform by solid angle.
    Vec3 sample(float u0, float u1) const {
        return Frame(axis).to_world(uniform_cap(one_minus_cos, u0, u1)).normalized();
    }
};

/// The concentric map of the square onto the unit disc.
inline Vec2 concentric_disc(float u0, float u1) {
    Vec2 disc;
    map_to_disc(u0, u1, disc.x(), disc.y());
    return disc;
}

/// Uniform point of the unit disc.
inline Vec2 uniform_disc(float u0, float u1) {
    const float r = std::sqrt(u0);
    const float angle = 2 * pi * u1;
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// Halton's sequence: the digits of `number` in a base, mirrored about the point, turned by `shift`
/// around [0, 1).
template <std::uint64_t base>
double radical_inverse(std::uint64_t number, double shift) {
    constexpr auto shares = [] {
        std::array<double, 64> all{};
        double share = 1;
        for (double& digit : all) digit = share /= static_cast<double>(base);
        return all;
    }();
    for (std::size_t digit = 0; number > 0; number /= base, ++digit)
        shift += static_cast<double>(number % base) * shares[digit];
    return shift - std::floor(shift);
}

/// The first index whose cumulative share exceeds u; `cumulative` ascends to 1.
inline std::size_t pick(const std::vector<double>& cumulative, float u) {
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), static_cast<double>(u));
    return std::min(static_cast<std::size_t>(at - cumulative.begin()), cumulative.size() - 1);
}

/// As pick(), and stretches the picked share of u over [0, 1) again.
inline std::size_t pick_and_stretch(const std::vector<double>& cumulative, double& u) {
    if (cumulative.size() == 1) return 0;
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    const auto index = static_cast<std::size_t>(at - cumulative.begin());
    const double low = index == 0 ? 0 : cumulative[index - 1];
    u = std::clamp((u - low) / (cumulative[index] - low), 0.0, 1.0);
    return index;
}

}  // namespace caustics

#pragma once

#include <cmath>

#include "core/math/vec.h"
#include "tests/support/fresnel.h"

namespace caustics::support::flat_pool {

// A point light of intensity I at height H above the water, the floor at depth D. A ray of angle
// a in air and b in water, sin a = n sin b, lands at r = H tan a + D tan b, and the flux
// I (1 - R(a)) sin a da dphi of its neighbourhood on r dr dphi:
//   E(r) = I (1 - R) sin a / (r dr/da),  dr/da = H / cos^2 a + D cos a / (n cos^3 b),
//   E(0) = I 4n / (n + 1)^2 / (H + D / n)^2.
inline constexpr double height = 2;
inline constexpr double depth = 1;
inline constexpr double index = 1.333;
inline constexpr double intensity = 10;

inline double landing_radius(double a, double light = height, double n = index) {
    return light * std::tan(a) + depth * std::tan(std::asin(std::sin(a) / n));
}

inline double floor_irradiance(double r, double light = height, double n = index) {
    if (r == 0) return intensity * 4 * n / std::pow((n + 1) * (light + depth / n), 2);
    double low = 0;
    double high = pi_d / 2 - 1e-9;
    for (int i = 0; i < 200; ++i) {
        const double middle = (low + high) / 2;
        (landing_radius(middle, light, n) < r ? low : high) = middle;
    }
    const double cos_a = std::cos(low);
    const double cos_b = refracted_cosine(cos_a, n);
    const double slope = light / (cos_a * cos_a) + depth * cos_a / (n * std::pow(cos_b, 3));
    return intensity * (1 - fresnel(cos_a, n)) * std::sin(low) / (r * slope);
}

}  // namespace caustics::support::flat_pool

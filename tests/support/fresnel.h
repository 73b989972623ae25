#pragma once

#include <cmath>

namespace caustics::support {

/// Closed forms in double, written apart from core/material/optics. `n` is the ior of the far side over
/// that of the near side.

/// Cosine of the refracted angle for a cosine of incidence; n above sin(incidence).
inline double refracted_cosine(double cos_i, double n) {
    return std::sqrt(1 - (1 - cos_i * cos_i) / (n * n));
}

/// Mean of R_s and R_p, what a renderer without polarisation uses at every interface.
inline double fresnel(double cos_i, double n) {
    if (1 - cos_i * cos_i >= n * n) return 1;
    const double cos_t = refracted_cosine(cos_i, n);
    const double rs = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    const double rp = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return (rs * rs + rp * rp) / 2;
}

/// Reflectance and transmittance.
struct Shares {
    double reflected, transmitted;
};

/// Plane-parallel slab with the share `a` left after each crossing, unpolarised at each
/// interface: the geometric series (1-R)^2 a sum (R a)^2k; without absorption T = (1-R)/(1+R).
inline Shares slab(double r, double a = 1) {
    const double series = 1 / (1 - r * r * a * a);
    return {r + r * (1 - r) * (1 - r) * a * a * series, (1 - r) * (1 - r) * a * series};
}

/// Two lossless parts one behind the other, with all their interreflections.
inline Shares stacked(const Shares& first, const Shares& second) {
    const double series = 1 / (1 - first.reflected * second.reflected);
    const double transmitted = first.transmitted * second.transmitted * series;
    return {1 - transmitted, transmitted};
}

}  // namespace caustics::support

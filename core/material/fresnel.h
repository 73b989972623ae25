#pragma once

#include <optional>

#include "core/math/vec.h"

namespace caustics {

/// Mirror image of `w` (unit, away from the surface) about the unit normal n.
inline Vec3 reflect(const Vec3& w, const Vec3& n) { return 2 * n.dot(w) * n - w; }

/// Direction (unit, away from the surface, on the other side of n) into which light arriving
/// from `w` is refracted; n on w's side; eta = (ior on the far side) / (ior on w's side).
/// Empty at total internal reflection. [Snell's law in vector form]
std::optional<Vec3> refract(const Vec3& w, const Vec3& n, float eta);

/// Unpolarised Fresnel reflectance of a dielectric, the mean of R_s and R_p; `cos_i` >= 0 on the
/// side of arrival; eta as for refract. 1 at total internal reflection.
float fresnel_dielectric(float cos_i, float eta);
/// The same where the cosine of refraction is known, in float or double.
template <typename Real>
Real fresnel_reflectance(Real cos_i, Real cos_t, Real eta) {
    const Real r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const Real r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return Real{0.5} * (r_s * r_s + r_p * r_p);
}

}  // namespace caustics

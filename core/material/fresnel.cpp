#include "core/material/fresnel.h"

#include <cmath>

namespace caustics {

std::optional<Vec3> refract(const Vec3& w, const Vec3& n, float eta) {
    const float cos_i = n.dot(w);
    const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return {};
    const float cos_t = std::sqrt(1 - sin2_t);
    const Vec3 t = (cos_i / eta - cos_t) * n - w / eta;
    return t.normalized();
}

float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    return fresnel_reflectance(cos_i, std::sqrt(1 - sin2_t), eta);
}

}  // namespace caustics

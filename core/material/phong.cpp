#include "core/material/phong.h"

#include <algorithm>
#include <cmath>

#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

// cos^e a; 0 beyond a right angle.
float lobe(float exponent, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    const float cosine = std::min(1.0F, 2 * n.dot(wo) * n.dot(wi) - wo.dot(wi));
    return cosine > 0 ? std::pow(cosine, exponent) : 0;
}

}  // namespace

Spectrum Phong::f_r(const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) const {
    const float about_mirror = lobe(exponent, n, wo, wi);
    const float specular = model == Model::normalised ? (exponent + 2) / (2 * pi) * about_mirror
                                                      : about_mirror / n.dot(wi);
    return evaluate(diffuse_reflectance, uv) * (1 / pi) +
           evaluate(specular_reflectance, uv) * specular;
}

Spectrum Phong::albedo(const Vec2& uv) const {
    return evaluate(diffuse_reflectance, uv) + evaluate(specular_reflectance, uv);
}

std::optional<Vec3> Phong::sample(const Vec3& n, const Vec3& wo, const Vec3& u) const {
    if (u[2] >= lobe_share) return Frame(n).to_world(cosine_hemisphere(u[0], u[1]));
    const float cosine = std::pow(u[0], 1 / (exponent + 1));
    const float sine = std::sqrt(std::max(0.0F, 1 - cosine * cosine));
    const float angle = 2 * pi * u[1];
    const Vec3 mirrored = 2 * n.dot(wo) * n - wo;
    const Vec3 wi = Frame(mirrored.normalized())
                        .to_world(Vec3(sine * std::cos(angle), sine * std::sin(angle), cosine));
    if (n.dot(wi) <= 0) return {};
    return wi;
}

float Phong::pdf(const Vec3& n, const Vec3& wo, const Vec3& wi) const {
    return (1 - lobe_share) * n.dot(wi) / pi +
           lobe_share * (exponent + 1) / (2 * pi) * lobe(exponent, n, wo, wi);
}

}  // namespace caustics

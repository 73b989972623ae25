#include "core/material/bsdf.h"

#include <algorithm>
#include <cmath>

#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

// [J96 (6)] divided by v: G(v)/v = 1/(alpha - alpha v + v) has no singularity at grazing.
float shadowing_over_cosine(float v, float alpha) { return 1 / (alpha - alpha * v + v); }

// The lobe Z(t) = alpha / (1 + alpha t^2 - t^2)^2 of [J96 (5)].
float schlick_lobe(float t2, float alpha) {
    const float denominator = 1 + alpha * t2 - t2;
    return alpha / (denominator * denominator);
}

// (n.h)^2 with the normalised half vector h. wo + wi itself, not 1 + wo.wi, which cancels for
// opposite grazing directions.
float half_vector_cosine_squared(float v, float v_in, const Vec3& wo, const Vec3& wi) {
    const float sum = v + v_in;
    return std::min(1.0F, sum * sum / Vec3(wo + wi).squaredNorm());
}

float schlick_value(float alpha, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    const float v = n.dot(wo);
    const float v_in = n.dot(wi);
    const float g =
        shadowing_over_cosine(v, alpha) * shadowing_over_cosine(v_in, alpha);  // G G' / (v v')
    const float t2 = half_vector_cosine_squared(v, v_in, wo, wi);
    return (1 - g * v * v_in) / pi + g / (4 * pi) * schlick_lobe(t2, alpha);
}

const Texture* reflectance_texture(const Bsdf& bsdf) {
    if (const auto* diffuse = std::get_if<Diffuse>(&bsdf.model)) return &diffuse->reflectance;
    if (const auto* schlick = std::get_if<Schlick>(&bsdf.model)) return &schlick->reflectance;
    return nullptr;
}

}  // namespace

float Dielectric::relative_ior(bool front, float nm) const {
    if (is_dispersive()) {
        const double ratio = int_ior.at(nm) / ext_ior.at(nm);
        return static_cast<float>(front ? ratio : 1 / ratio);
    }
    const auto inside = static_cast<float>(int_ior.n());
    const auto outside = static_cast<float>(ext_ior.n());
    return front ? inside / outside : outside / inside;
}

bool is_dispersive(const Bsdf& bsdf) {
    const auto* glass = std::get_if<Dielectric>(&bsdf.model);
    return glass != nullptr && glass->is_dispersive();
}

bool is_caster(const Bsdf& bsdf) {
    return std::holds_alternative<Dielectric>(bsdf.model) ||
           std::holds_alternative<Conductor>(bsdf.model);
}

bool is_receiver(const Bsdf& bsdf) { return !is_caster(bsdf); }

bool scatters_from(const Bsdf& bsdf, bool front) {
    return front || bsdf.twosided || std::holds_alternative<Dielectric>(bsdf.model);
}

Spectrum evaluate(const Bsdf& bsdf, const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    const Texture* reflectance = reflectance_texture(bsdf);
    if (reflectance == nullptr || n.dot(wo) <= 0 || n.dot(wi) <= 0) return black();
    const auto* schlick = std::get_if<Schlick>(&bsdf.model);
    const float value = schlick != nullptr ? schlick_value(schlick->alpha, n, wo, wi) : 1 / pi;
    return evaluate(*reflectance, uv) * value;
}

Spectrum albedo(const Bsdf& bsdf, const Vec2& uv) {
    const Texture* reflectance = reflectance_texture(bsdf);
    return reflectance != nullptr ? evaluate(*reflectance, uv) : Spectrum(Spectrum::Ones());
}

std::optional<Vec3> sample_direction(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, float u0,
                                     float u1, float u2) {
    const Frame frame(n);
    const auto* schlick = std::get_if<Schlick>(&bsdf.model);
    if (schlick == nullptr || u2 < 0.5F) return frame.to_world(cosine_hemisphere(u0, u1));
    const float t2 = u0 / (schlick->alpha + (1 - schlick->alpha) * u0);
    const float sine = std::sqrt(std::max(0.0F, 1 - t2));
    const float angle = 2 * pi * u1;
    const Vec3 half =
        frame.to_world(Vec3(sine * std::cos(angle), sine * std::sin(angle), std::sqrt(t2)));
    const Vec3 wi = 2 * half.dot(wo) * half - wo;
    if (n.dot(wi) <= 0) return {};
    return wi.normalized();
}

float direction_pdf(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    const float cosine = n.dot(wi);
    if (cosine <= 0) return 0;
    const float cosine_pdf = cosine / pi;
    const auto* schlick = std::get_if<Schlick>(&bsdf.model);
    if (schlick == nullptr) return cosine_pdf;
    const float t2 = half_vector_cosine_squared(n.dot(wo), cosine, wo, wi);
    const float wo_half = Vec3(wo + wi).norm() / 2;
    const float lobe_pdf = schlick_lobe(t2, schlick->alpha) * std::sqrt(t2) / pi / (4 * wo_half);
    return 0.5F * (cosine_pdf + lobe_pdf);
}

}  // namespace caustics

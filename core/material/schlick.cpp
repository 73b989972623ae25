#include "core/material/schlick.h"

#include <algorithm>
#include <cmath>

#include "core/material/texture_reader.h"
#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {

using namespace scene_file;

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

}  // namespace

Spectrum Schlick::f_r(const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) const {
    const float v = n.dot(wo);
    const float v_in = n.dot(wi);
    const float g =
        shadowing_over_cosine(v, alpha) * shadowing_over_cosine(v_in, alpha);  // G G' / (v v')
    const float t2 = half_vector_cosine_squared(v, v_in, wo, wi);
    const float value = (1 - g * v * v_in) / pi + g / (4 * pi) * schlick_lobe(t2, alpha);
    return evaluate(reflectance, uv) * value;
}

Spectrum Schlick::albedo(const Vec2& uv) const { return evaluate(reflectance, uv); }

std::optional<Vec3> Schlick::sample(const Vec3& n, const Vec3& wo, const Vec3& u) const {
    const Frame frame(n);
    if (u[2] < 0.5F) return frame.to_world(cosine_hemisphere(u[0], u[1]));
    const float t2 = u[0] / (alpha + (1 - alpha) * u[0]);
    const float sine = std::sqrt(std::max(0.0F, 1 - t2));
    const float angle = 2 * pi * u[1];
    const Vec3 half =
        frame.to_world(Vec3(sine * std::cos(angle), sine * std::sin(angle), std::sqrt(t2)));
    const Vec3 wi = 2 * half.dot(wo) * half - wo;
    if (n.dot(wi) <= 0) return {};
    return wi.normalized();
}

float Schlick::pdf(const Vec3& n, const Vec3& wo, const Vec3& wi) const {
    const float cosine = n.dot(wi);
    const float cosine_pdf = cosine / pi;
    const float t2 = half_vector_cosine_squared(n.dot(wo), cosine, wo, wi);
    const float wo_half = Vec3(wo + wi).norm() / 2;
    const float lobe_pdf = schlick_lobe(t2, alpha) * std::sqrt(t2) / pi / (4 * wo_half);
    return 0.5F * (cosine_pdf + lobe_pdf);
}

ObjectText Schlick::text() {
    return {"schlick",
            "A bsdf, in a shape: Schlick's glossy model.",
            {type_key(),
             texture("reflectance", "Factor of the model.", "0.5"),
             {.key = "alpha",
              .meaning = "Roughness: 1 is broad, towards 0 a mirror.",
              .source = "[J96 (5)]",
              .type = "number",
              .usual = "1",
              .choices = "0.000001 to 1"}}};
}

Schlick Schlick::read(const JsonNode& node, Assets& assets) {
    Schlick schlick;
    schlick.reflectance = read_texture(node, "reflectance", 0.5, assets);
    if (const auto alpha = node.find("alpha")) {
        schlick.alpha = static_cast<float>(alpha->as_number_in(0, 1));
        if (schlick.alpha < 1e-6F)
            alpha->fail("must be above 0 (at 0 the model is a mirror; use a conductor)");
    }
    return schlick;
}

// Z falls to half where 1 - (1 - alpha) t^2 has grown by the root of 2; h turns by half of what wi does.
std::optional<float> Schlick::lobe_half_width() const {
    const float grown = std::sqrt(2.0F) * alpha;
    if (grown >= 1) return {};
    return 2 * std::acos(std::sqrt((1 - grown) / (1 - alpha)));
}

void Schlick::add_scattering_to(ValueHash& hash) const {
    caustics::add_to(hash, reflectance);
    hash.add(alpha);
}

}  // namespace caustics

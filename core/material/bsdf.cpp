#include "core/material/bsdf.h"

namespace caustics {
namespace {

template <class Model>
concept Receiver = requires(const Model& model, const Vec3& v) {
    { model.pdf(v, v, v) };
};

// What a receiver's model answers; `otherwise` for a caster's.
template <class Result, class Ask>
Result ask_receiver(const Bsdf& bsdf, const Ask& ask, const Result& otherwise) {
    return std::visit(
        [&]<class Model>(const Model& model) -> Result {
            if constexpr (Receiver<Model>)
                return ask(model);
            else
                return otherwise;
        },
        bsdf.model);
}

}  // namespace

bool is_caster(const Bsdf& bsdf) {
    return std::holds_alternative<Dielectric>(bsdf.model) ||
           std::holds_alternative<Conductor>(bsdf.model) || bsdf.mirror.has_value();
}

bool is_receiver(const Bsdf& bsdf) {
    return ask_receiver<bool>(bsdf, [](const auto&) { return true; }, false);
}

bool is_dispersive(const Bsdf& bsdf) {
    const auto* glass = std::get_if<Dielectric>(&bsdf.model);
    return glass != nullptr && glass->is_dispersive();
}

bool scatters_from(const Bsdf& bsdf, bool front) {
    return front || bsdf.twosided || std::holds_alternative<Dielectric>(bsdf.model);
}

Spectrum evaluate(const Bsdf& bsdf, const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    if (n.dot(wo) <= 0 || n.dot(wi) <= 0) return black();
    const Spectrum value = ask_receiver<Spectrum>(
        bsdf, [&](const auto& model) { return model.f_r(uv, n, wo, wi); }, black());
    return bsdf.mirror ? Spectrum(value * (1 - bsdf.mirror->weight)) : value;
}

Spectrum albedo(const Bsdf& bsdf, const Vec2& uv) {
    const Spectrum value = ask_receiver<Spectrum>(
        bsdf, [&](const auto& model) { return model.albedo(uv); }, Spectrum::Ones());
    return bsdf.mirror ? Spectrum(value * (1 - bsdf.mirror->weight)) : value;
}

std::optional<Vec3> sample_direction(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, float u0,
                                     float u1, float u2) {
    const Vec3 u(u0, u1, u2);
    return ask_receiver<std::optional<Vec3>>(
        bsdf, [&](const auto& model) { return model.sample(n, wo, u); }, std::nullopt);
}

float direction_pdf(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    if (n.dot(wi) <= 0) return 0;
    return ask_receiver<float>(bsdf, [&](const auto& model) { return model.pdf(n, wo, wi); }, 0);
}

}  // namespace caustics

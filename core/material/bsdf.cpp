#include "core/material/bsdf.h"

#include <fmt/format.h>

namespace caustics {
namespace {

template <class Model>
concept Receiver = requires(const Model& model, const Vec3& v) {
    { model.pdf(v, v, v) };
};

template <class Model>
concept Caster = requires(const Model& model) { model.split(SpecularArrival{}); };

// Both of its sides scatter light, as each is a medium's.
template <class Model>
concept Interface = requires(const Model& model) { model.medium(true); };

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
    return bsdf.mirror ||
           std::visit([]<class Model>(const Model&) { return Caster<Model>; }, bsdf.model);
}

bool is_receiver(const Bsdf& bsdf) {
    return ask_receiver<bool>(bsdf, [](const auto&) { return true; }, false);
}

std::optional<float> lobe_half_width(const Bsdf& bsdf) {
    return std::visit(
        [](const auto& model) -> std::optional<float> {
            if constexpr (requires { model.lobe_half_width(); })
                return model.lobe_half_width();
            else
                return {};
        },
        bsdf.model);
}

bool is_dispersive(const Bsdf& bsdf) {
    return std::visit(
        [](const auto& model) {
            if constexpr (requires { model.is_dispersive(); })
                return model.is_dispersive();
            else
                return false;
        },
        bsdf.model);
}

bool scatters_from(const Bsdf& bsdf, bool front) {
    return front || bsdf.twosided ||
           std::visit([]<class Model>(const Model&) { return Interface<Model>; }, bsdf.model);
}

Spectrum evaluate(const Bsdf& bsdf, const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    if (n.dot(wo) <= 0 || n.dot(wi) <= 0) return black();
    const Spectrum value = ask_receiver<Spectrum>(
        bsdf, [&](const auto& model) { return model.f_r(uv, n, wo, wi); }, black());
    return bsdf.mirror ? Spectrum(value * (1 - bsdf.mirror->weight)) : value;
}

Bsdf bsdf_at(const Bsdf& bsdf, const Vec2& uv) {
    Bsdf at{.twosided = bsdf.twosided, .mirror = bsdf.mirror};
    std::visit(
        [&]<class Model>(const Model& model) {
            if constexpr (Receiver<Model>)
                at.model = model.at(uv);
            else
                at.model = model;
        },
        bsdf.model);
    return at;
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

namespace {

// For a model that another program lacks.
template <class Model>
ExportRefusal unknown(const char* program) {
    return {fmt::format("{} has no {} bsdf; give the shape one that it has", program,
                        Model::text().name),
            "/bsdf={\"type\":\"diffuse\",\"reflectance\":0.5}"};
}

}  // namespace

MitsubaBsdf to_mitsuba(const Bsdf& bsdf) {
    return std::visit(
        []<class Model>(const Model& model) -> MitsubaBsdf {
            if constexpr (requires { model.to_mitsuba(); })
                return model.to_mitsuba();
            else
                return {.refused = unknown<Model>("Mitsuba")};
        },
        bsdf.model);
}

PovraySurface to_povray(const Bsdf& bsdf) {
    return std::visit(
        []<class Model>(const Model& model) -> PovraySurface {
            if constexpr (requires { model.to_povray(); })
                return model.to_povray();
            else
                return {.refused = unknown<Model>("POV-Ray")};
        },
        bsdf.model);
}

}  // namespace caustics

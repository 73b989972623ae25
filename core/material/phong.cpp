#include "core/material/phong.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/material/texture_reader.h"
#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {

using namespace scene_file;

namespace {

// cos^e a; 0 beyond a right angle.
float phong_lobe(float exponent, const Vec3& n, const Vec3& wo, const Vec3& wi) {
    const float cosine = std::min(1.0F, 2 * n.dot(wo) * n.dot(wi) - wo.dot(wi));
    return cosine > 0 ? std::pow(cosine, exponent) : 0;
}

float brightest(const Texture& texture) {
    if (const auto* colour = std::get_if<Spectrum>(&texture)) return colour->maxCoeff();
    if (const auto* board = std::get_if<Checkerboard>(&texture))
        return std::max(board->color0.maxCoeff(), board->color1.maxCoeff());
    float most = 0;
    for (const Spectrum& texel : std::get<Bitmap>(texture).texels)
        most = std::max(most, texel.maxCoeff());
    return most;
}

// Of one colour, whether the two together are at most 1 in each channel; of textures, whether their
// brightest places are.
bool keeps_energy(const Texture& diffuse, const Texture& specular) {
    constexpr float most = 1 + 1e-6F;
    const auto* d = std::get_if<Spectrum>(&diffuse);
    const auto* s = std::get_if<Spectrum>(&specular);
    if (d != nullptr && s != nullptr) return (*d + *s <= most).all();
    return brightest(diffuse) + brightest(specular) <= most;
}

}  // namespace

Spectrum Phong::f_r(const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi) const {
    const float about_mirror = phong_lobe(exponent, n, wo, wi);
    const float specular = model == Model::normalised ? (exponent + 2) / (2 * pi) * about_mirror
                                                      : about_mirror / n.dot(wi);
    return evaluate(diffuse_reflectance, uv) * (1 / pi) +
           evaluate(specular_reflectance, uv) * specular;
}

Spectrum Phong::albedo(const Vec2& uv) const {
    return evaluate(diffuse_reflectance, uv) + evaluate(specular_reflectance, uv);
}

Phong Phong::at(const Vec2& uv) const {
    return {evaluate(diffuse_reflectance, uv), evaluate(specular_reflectance, uv), exponent, model,
            lobe_share};
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
           lobe_share * (exponent + 1) / (2 * pi) * phong_lobe(exponent, n, wo, wi);
}

ObjectText Phong::text() {
    return {"phong",
            "A bsdf, in a shape: Lambert's law and Phong's lobe about the mirror direction.",
            {type_key(),
             texture("diffuse_reflectance", "Share of the light that is scattered evenly.", "0.5"),
             texture("specular_reflectance",
                     "Share that goes to the lobe; the two together at most 1.", "0.2"),
             number("exponent", "How narrow the lobe is.", "", "30", "0 to 1000000"),
             choice("model", "Energy is kept, or the law of 1975 as it was.", "normalised",
                    "normalised, classic")}};
}

Phong Phong::read(const JsonNode& node, Assets& assets) {
    Phong phong;
    phong.diffuse_reflectance = read_texture(node, "diffuse_reflectance", 0.5, assets);
    phong.specular_reflectance = read_texture(node, "specular_reflectance", 0.2, assets);
    if (const auto exponent = node.find("exponent"))
        phong.exponent = static_cast<float>(exponent->as_number_in(0, 1e6));
    if (const auto model = node.find("model"))
        phong.model = static_cast<Phong::Model>(model->as_choice({"normalised", "classic"}));
    if (phong.model == Phong::Model::normalised &&
        !keeps_energy(phong.diffuse_reflectance, phong.specular_reflectance))
        node.fail(
            "diffuse_reflectance and specular_reflectance together are above 1: more light would "
            "leave than arrives (the model \"classic\" takes them)");
    const float d = brightest(phong.diffuse_reflectance);
    const float s = brightest(phong.specular_reflectance);
    if (d + s > 0) phong.lobe_share = s / (d + s);
    return phong;
}

PovraySurface Phong::to_povray() const {
    const auto* specular = std::get_if<Spectrum>(&specular_reflectance);
    PovraySurface surface{.pigment = diffuse_reflectance};
    if (model != Model::classic)
        surface.refused.reason =
            "POV-Ray's highlight is that of the model \"classic\"; the normalised one is not "
            "exported";
    else if (specular == nullptr || (*specular != (*specular)[0]).any())
        surface.refused.reason =
            "POV-Ray's highlight has one strength: give specular_reflectance a number";
    else
        surface.highlight = fmt::format(" phong {} phong_size {}", pi * (*specular)[0], exponent);
    return surface;
}

std::optional<float> Phong::lobe_half_width() const {
    if (!(lobe_share > 0)) return {};
    const float cosine = std::pow(0.5F, 1 / exponent);
    return cosine > 0 ? std::optional(std::acos(cosine)) : std::nullopt;
}

void Phong::add_scattering_to(ValueHash& hash) const {
    caustics::add_to(hash, diffuse_reflectance);
    caustics::add_to(hash, specular_reflectance);
    hash.add(exponent);
    hash.add(model);
}

}  // namespace caustics

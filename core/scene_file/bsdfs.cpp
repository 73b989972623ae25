#include "core/scene_file/bsdfs.h"

#include <algorithm>

#include "core/scene_file/iors.h"

namespace caustics::scene_file {
namespace {

const std::vector<std::string> later_types{
    "roughconductor", "roughdielectric", "plastic", "thindielectric", "mask", "principled", "ref"};

Dielectric read_dielectric(const JsonNode& node) {
    Dielectric glass;
    glass.int_ior = read_ior(node, "int_ior", glass.int_ior);
    glass.ext_ior = read_ior(node, "ext_ior", glass.ext_ior);
    glass.absorption = read_colour(node, "absorption", 0, unlimited);
    glass.ext_absorption = read_colour(node, "ext_absorption", 0, unlimited);
    glass.specular_reflectance = read_colour(node, "specular_reflectance", 1, 1);
    glass.specular_transmittance = read_colour(node, "specular_transmittance", 1, 1);
    return glass;
}

Conductor read_conductor(const JsonNode& node) {
    if (const auto material = node.find("material"))
        if (material->as_string() != "none")
            material->fail("material \"" + material->as_string() +
                           "\" is not supported (yet) (known: none)");
    return {read_colour(node, "specular_reflectance", 1, 1)};
}

Schlick read_schlick(const JsonNode& node, Assets& assets) {
    Schlick schlick;
    schlick.reflectance = read_texture(node, "reflectance", 0.5, assets);
    if (const auto alpha = node.find("alpha")) {
        schlick.alpha = static_cast<float>(alpha->as_number_in(0, 1));
        if (schlick.alpha < 1e-6F)
            alpha->fail("must be above 0 (at 0 the model is a mirror; use a conductor)");
    }
    return schlick;
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

Phong read_phong(const JsonNode& node, Assets& assets) {
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

// Mitsuba's order: weight 0 is the first of the two by the names of their keys, 1 the second.
Bsdf read_blend(const JsonNode& node, Assets& assets) {
    float weight = 0.5F;
    if (const auto given = node.find("weight")) {
        if (given->is_object())
            given->fail("a textured weight is not supported (yet); give a number from 0 to 1");
        weight = static_cast<float>(given->as_number_in(0, 1));
    }
    const auto children = node.children();
    node.finish();
    if (children.size() != 2)
        node.fail(
            "blendbsdf takes exactly two nested bsdfs: one of diffuse, schlick, phong and a "
            "conductor");
    const Bsdf first = read_bsdf(children[0].second, assets);
    const Bsdf second = read_bsdf(children[1].second, assets);
    const bool is_first = std::holds_alternative<Conductor>(first.model);
    const Bsdf& mirror = is_first ? first : second;
    Bsdf blend = is_first ? second : first;
    if (!std::holds_alternative<Conductor>(mirror.model) || is_caster(blend) || blend.twosided ||
        mirror.twosided)
        node.fail(
            "blendbsdf blends one of diffuse, schlick, phong with a conductor (twosided goes "
            "around the blend)");
    if (is_first) weight = 1 - weight;
    if (weight == 0) return blend;
    if (weight == 1) return mirror;
    blend.mirror = MirrorPart{weight, std::get<Conductor>(mirror.model).specular_reflectance};
    return blend;
}

Bsdf read_twosided(const JsonNode& node, Assets& assets) {
    const auto children = node.children();
    node.finish();
    if (children.size() != 1)
        node.fail(
            "twosided takes exactly one nested bsdf, the same on both sides (known: diffuse, "
            "schlick, phong, conductor, blendbsdf)");
    Bsdf inner = read_bsdf(children.front().second, assets);
    if (inner.twosided || std::holds_alternative<Dielectric>(inner.model))
        children.front().second.fail(
            "only one-sided bsdfs can be made twosided (diffuse, schlick, phong, conductor, "
            "blendbsdf)");
    inner.twosided = true;
    return inner;
}

}  // namespace

const std::vector<std::string>& bsdf_types() {
    static const std::vector<std::string> types{"diffuse",   "schlick",   "phong",   "dielectric",
                                                "conductor", "blendbsdf", "twosided"};
    return types;
}

bool is_bsdf_type(const std::string& type) {
    return std::ranges::find(bsdf_types(), type) != bsdf_types().end() ||
           std::ranges::find(later_types, type) != later_types.end();
}

Bsdf read_bsdf(const JsonNode& node, Assets& assets) {
    const std::string type = read_type(node, "bsdf", bsdf_types(), later_types);
    Bsdf bsdf;
    if (type == "twosided") return read_twosided(node, assets);
    if (type == "blendbsdf") return read_blend(node, assets);
    if (type == "diffuse") bsdf.model = Diffuse{read_texture(node, "reflectance", 0.5, assets)};
    if (type == "schlick") bsdf.model = read_schlick(node, assets);
    if (type == "phong") bsdf.model = read_phong(node, assets);
    if (type == "dielectric") bsdf.model = read_dielectric(node);
    if (type == "conductor") bsdf.model = read_conductor(node);
    node.finish();
    return bsdf;
}

}  // namespace caustics::scene_file

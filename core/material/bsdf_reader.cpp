#include "core/material/bsdf_reader.h"

#include <algorithm>

#include "core/base/each_kind.h"

namespace caustics::scene_file {
namespace {

constexpr const char* twosided_type = "twosided";
constexpr const char* blend_type = "blendbsdf";
const std::vector<std::string> later_types{
    "roughconductor", "roughdielectric", "plastic", "thindielectric", "mask", "principled", "ref"};

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

ObjectText blend_text() {
    return {
        blend_type,
        "A bsdf, in a shape: one of diffuse, schlick, phong and a conductor, which it holds; the "
        "shape is a receiver and a caster.",
        {type_key(), number("weight",
                            "Share of the second of the two, by the names of their keys; the "
                            "first has the rest.",
                            "", "0.5", "0 to 1")}};
}

ObjectText twosided_text() {
    return {
        twosided_type,
        "A bsdf, in a shape: the diffuse, schlick, phong, conductor or blendbsdf that it holds, "
        "on both sides.",
        {type_key()}};
}

using Model = decltype(Bsdf::model);

}  // namespace

const std::vector<std::string>& bsdf_types() {
    static const std::vector<std::string> types = [] {
        std::vector<std::string> all;
        for (const ObjectText& object : bsdf_keys()) all.push_back(object.name);
        return all;
    }();
    return types;
}

bool is_bsdf_type(const std::string& type) {
    return std::ranges::find(bsdf_types(), type) != bsdf_types().end() ||
           std::ranges::find(later_types, type) != later_types.end();
}

Bsdf read_bsdf(const JsonNode& node, Assets& assets) {
    const std::string type = read_type(node, "bsdf", bsdf_types(), later_types);
    if (type == twosided_type) return read_twosided(node, assets);
    if (type == blend_type) return read_blend(node, assets);
    Bsdf bsdf;
    each_kind(std::type_identity<Model>(), [&]<class Kind>(std::type_identity<Kind>) {
        if (type == name_of<Kind>()) bsdf.model = Kind::read(node, assets);
    });
    node.finish();
    return bsdf;
}

Objects bsdf_keys() {
    Objects all;
    each_kind(std::type_identity<Model>(),
              [&]<class Kind>(std::type_identity<Kind>) { all.push_back(Kind::text()); });
    all.push_back(blend_text());
    all.push_back(twosided_text());
    return all;
}

}  // namespace caustics::scene_file

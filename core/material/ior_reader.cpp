#include "core/material/ior_reader.h"

#include <array>
#include <utility>

#include "core/base/lower_case.h"
#include "core/base/near_words.h"

namespace caustics::scene_file {
namespace {

// Refractive indices by name, with Mitsuba 3's constants.
constexpr std::array<std::pair<const char*, float>, 23> named_iors{{
    {"vacuum", 1.0F},      {"helium", 1.000036F},        {"hydrogen", 1.000132F},
    {"air", 1.000277F},    {"carbon dioxide", 1.00045F}, {"water", 1.3330F},
    {"acetone", 1.36F},    {"ethanol", 1.361F},          {"carbon tetrachloride", 1.461F},
    {"glycerol", 1.4729F}, {"benzene", 1.501F},          {"silicone oil", 1.52045F},
    {"bromine", 1.661F},   {"water ice", 1.31F},         {"fused quartz", 1.458F},
    {"pyrex", 1.470F},     {"acrylic glass", 1.49F},     {"polypropylene", 1.49F},
    {"bk7", 1.5046F},      {"sodium chloride", 1.544F},  {"amber", 1.55F},
    {"pet", 1.5750F},      {"diamond", 2.419F},
}};

Ior read_named_glass(const JsonNode& node) {
    const std::string name = lower_case(node.as_string());
    std::vector<std::string> known;
    for (const NamedGlass& glass : named_glasses()) {
        if (name == glass.name) return Ior::sellmeier(glass.terms);
        known.emplace_back(glass.name);
    }
    node.fail("unknown glass \"" + node.as_string() + "\"" + did_you_mean(name, known) +
              " (known: " + named_glass_list() + ")");
}

Ior read_sellmeier(const JsonNode& node) {
    const auto material = node.find("material");
    const auto b_node = node.find("B");
    const auto c_node = node.find("C");
    if (material) {
        if (b_node || c_node) material->fail("give either a material or B and C");
        return read_named_glass(*material);
    }
    const std::vector<JsonNode> b = node.at("B").as_array();
    const std::vector<JsonNode> c = node.at("C").as_array();
    if (b.empty() || b.size() != c.size())
        node.fail("B and C of sellmeier's law are lists of equal length, at least 1");
    std::vector<Ior::SellmeierTerm> terms;
    for (std::size_t i = 0; i < b.size(); ++i)
        terms.push_back({b[i].as_number_in(-1e6, 1e6), c[i].as_number_in(-1e6, 1e6)});
    return Ior::sellmeier(std::move(terms));
}

Ior read_law(const JsonNode& node) {
    const std::string type = read_type(node, "law of dispersion", {"cauchy", "sellmeier", "abbe"});
    Ior ior = 1;
    if (type == "cauchy") {
        const double a = node.at("A").as_number_in(-1e6, 1e6);
        ior = Ior::cauchy(a, node.at("B").as_number_in(-1e6, 1e6));
    }
    if (type == "sellmeier") ior = read_sellmeier(node);
    if (type == "abbe") {
        const JsonNode v_d = node.at("V_d");
        if (v_d.as_number_in(0, 1e6) == 0) v_d.fail("must be above 0");
        ior = Ior::abbe(node.at("n_d").as_number_in(1, 10), v_d.as_number());
    }
    node.finish();
    if (const auto why = ior.why_unusable())
        node.fail(*why + " (between 380 and 730 nm a law gives numbers from 1 to 10)");
    return ior;
}

}  // namespace

Ior read_ior(const JsonNode& parent, const std::string& key, const Ior& fallback) {
    const auto node = parent.find(key);
    if (!node) return fallback;
    if (node->is_object()) return read_law(*node);
    if (node->is_number()) return static_cast<float>(node->as_number_in(0.1, 10));
    if (!node->is_string())
        node->fail("expected a number, a name or a law of dispersion (an object with a type)");
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& [name, ior] : named_iors) all.emplace_back(name);
        return all;
    }();
    return named_iors[node->as_choice(names)].second;
}

Objects ior_keys() {
    const auto law = [](const std::string& key, const std::string& meaning, const std::string& type,
                        const std::string& unit = {}, const std::string& range = {}) {
        return KeyText{
            .key = key, .meaning = meaning, .unit = unit, .type = type, .choices = range};
    };
    KeyText material = law("material", "A glass by its name, in place of B and C.", "word");
    material.usual = "none";
    material.choices = named_glass_list();
    return {
        {"cauchy",
         "A law of dispersion, for an index of refraction: n = A + B / l^2, l the wavelength in "
         "um.",
         {type_key(), law("A", "n of very long waves.", "number", "", "-1000000 to 1000000"),
          law("B", "How it grows to shorter ones.", "number", "um^2", "-1000000 to 1000000")}},
        {"sellmeier",
         "A law of dispersion: n^2 = 1 + sum of B l^2 / (l^2 - C), as glass catalogues give it.",
         {type_key(), material, law("B", "One for each term.", "list of numbers"),
          law("C", "As many.", "list of numbers", "um^2")}},
        {"abbe",
         "A law of dispersion: Cauchy's through n_d, with Abbe's number.",
         {type_key(), law("n_d", "n at 587.6 nm.", "number", "", "1 to 10"),
          law("V_d", "(n_d - 1) / (n_F - n_C): small where colours part widely.", "number", "",
              "above 0, to 1000000")}}};
}

}  // namespace caustics::scene_file

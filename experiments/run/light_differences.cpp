#include "experiments/run/light_differences.h"

#include <fmt/format.h>

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/base/bounded_json.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

/// An attribute of a picture, an empty object where it is missing or not one.
json attribute(const Film& film, const char* name) {
    const auto found = film.metadata.find(name);
    if (found == film.metadata.end()) return json::object();
    json value = parse_bounded_or_discard(found->second);
    return value.is_object() ? value : json::object();
}

/// How many samples estimate the light is no part of it.
json without_sampler(json scene) {
    for (json& child : scene)
        if (child.is_object()) child.erase("sampler");
    return scene;
}

/// Whatever is written in a file, without its control characters.
std::string visible(const std::string& key) {
    const std::string quoted = json(key).dump(-1, ' ', false, json::error_handler_t::replace);
    return quoted.substr(1, quoted.size() - 2);
}

/// By pointer; of an empty object nothing.
json plain_values(const json& object) {
    json values = object.flatten();
    values.erase("");
    return values;
}

std::string text_of(const json& values, const std::string& key) {
    return values.contains(key) ? values.at(key).dump() : "absent";
}

/// The members that differ between two objects of plain values.
void add_differences(std::vector<std::string>& all, const json& a, const json& b) {
    std::set<std::string> keys;
    for (const json* each : {&a, &b})
        for (const auto& member : each->items()) keys.insert(member.key());
    for (const std::string& key : keys)
        if (text_of(a, key) != text_of(b, key))
            all.push_back(
                fmt::format("{}: {} against {}", visible(key), text_of(a, key), text_of(b, key)));
}

/// Of one method's parameters those of `names` that both pictures have, as "PREFIXname".
json path_parameters(const Film& film, const Film& other, const char* attribute_name,
                     const char* prefix, std::initializer_list<const char*> names) {
    json counted = json::object();
    const json all = attribute(film, attribute_name);
    const json others = attribute(other, attribute_name);
    for (const char* name : names)
        if (all.contains(name) && others.contains(name))
            counted[std::string(prefix) + name] = all.at(name);
    return counted;
}

/// What a picture asks of its methods in the light of `layer`.
json asked_paths(const Film& film, const Film& other, const std::string& layer) {
    json asked = path_parameters(film, other, "parameters", "", {"max_bounces"});
    const bool is_whole = layer.empty();
    if (is_whole || layer == "direct")
        asked.update(path_parameters(film, other, "parameters", "", {"shadows"}));
    if (is_whole || layer == "indirect")
        asked.update(path_parameters(film, other, "indirect_parameters", "indirect_",
                                     {"max_bounces", "diffuse_bounces"}));
    if (is_whole && film.metadata.contains("scene") && other.metadata.contains("scene"))
        asked["light between surfaces"] = film.has_layer("indirect");
    return asked;
}

}  // namespace

std::vector<std::string> light_differences(const Film& picture, const Film& reference,
                                           const std::string& layer) {
    std::vector<std::string> all;
    add_differences(all, asked_paths(picture, reference, layer),
                    asked_paths(reference, picture, layer));
    if (!picture.metadata.contains("scene") || !reference.metadata.contains("scene")) return all;
    add_differences(all, plain_values(without_sampler(attribute(picture, "scene"))),
                    plain_values(without_sampler(attribute(reference, "scene"))));
    add_differences(all, attribute(picture, "scene_assets"), attribute(reference, "scene_assets"));
    return all;
}

}  // namespace caustics::experiments

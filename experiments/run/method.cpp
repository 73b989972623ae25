#include "experiments/run/method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/run/methods.h"

namespace caustics::experiments {

using nlohmann::json;

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const MethodDescription* each : all_methods()) all.push_back(each->facts().name);
        return all;
    }();
    return names;
}

const MethodDescription* find_method(const std::string& name) {
    for (const MethodDescription* each : all_methods())
        if (each->facts().name == name) return each;
    return nullptr;
}

Method parse_method(const std::string& name, const JsonNode& params) {
    if (const MethodDescription* const found = find_method(name))
        return {name, found, found->configure(params)};
    throw InputError(
        fmt::format("unknown method \"{}\" (known: {})", name, fmt::join(method_names(), ", ")));
}

JsonNode parameters_node(const std::vector<std::string>& assignments) {
    json object = json::object();
    for (const std::string& assignment : assignments) {
        const std::size_t equals = assignment.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(fmt::format("--param \"{}\": expected key=value", assignment));
        const std::string key = assignment.substr(0, equals);
        const std::string text = assignment.substr(equals + 1);
        if (object.contains(key)) throw InputError(fmt::format("--param \"{}\": given twice", key));
        json value = json::parse(text, nullptr, false);
        object[key] = value.is_discarded() ? json(text) : std::move(value);
    }
    return JsonNode::parse_text(object.dump(), "--param");
}

json describe(const Method& method) {
    json all = json::object();
    for (const auto& [key, value] : method.configured->values())
        all[key] = std::visit([](const auto& typed) { return json(typed); }, value);
    return all;
}

std::map<std::string, std::string> files_read(const Method& method) {
    std::map<std::string, std::string> all;
    for (const auto& [parameter, checksum] : method.configured->files_read())
        all[parameter] = hex(checksum);
    return all;
}

json identity(const Method& method) {
    json all = describe(method);
    for (const auto& [parameter, hash] : files_read(method)) all[parameter] = hash;
    return all;
}

int pass_count(const Method& method) { return method.configured->pass_count(); }

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const Method& method,
                                              const RunOptions& options, int pass) {
    return method.configured->build(scene, options, pass);
}

std::optional<std::string> why_unsupported(const Scene& scene, const Method& method) {
    RunOptions options;
    try {
        method.configured->with_least_work()->build(scene, options, 0);
        return {};
    } catch (const UnsupportedScene& unsupported) {
        return unsupported.what();
    }
}

bool gathers_over_discs(const Method& method) { return method.facts().gathers_over_discs; }

double disc_radius(const Method& method) { return method.configured->disc_radius(); }

}  // namespace caustics::experiments

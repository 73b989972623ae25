#include "experiments/run/method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "core/base/decimal.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/near_words.h"
#include "experiments/base/bounded_json.h"
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
    throw InputError(fmt::format("unknown method \"{}\"{} (known: {})", name,
                                 did_you_mean(name, method_names()),
                                 fmt::join(method_names(), ", ")));
}

const std::vector<std::string>& indirect_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all = {"none"};
        for (const IndirectDescription* each : all_indirect_methods())
            all.push_back(each->facts().name);
        return all;
    }();
    return names;
}

std::optional<IndirectMethod> parse_indirect(const std::string& name, const JsonNode& params) {
    if (name == "none") {
        params.finish();
        return {};
    }
    for (const IndirectDescription* each : all_indirect_methods())
        if (each->facts().name == name) return IndirectMethod{name, each, each->configure(params)};
    throw InputError(fmt::format("unknown indirect method \"{}\"{} (known: {})", name,
                                 did_you_mean(name, indirect_names()),
                                 fmt::join(indirect_names(), ", ")));
}

namespace {

json value_or_string(const std::string& text) {
    json value = parse_bounded_or_discard(text);
    if (!value.is_discarded()) return value;
    const std::optional<double> number = decimal<double>(text);
    return number ? json(*number) : json(text);
}

}  // namespace

JsonNode parameters_node(const std::vector<std::string>& assignments, const std::string& option) {
    json object = json::object();
    for (const std::string& assignment : assignments) {
        const std::size_t equals = assignment.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(fmt::format("{} \"{}\": expected key=value", option, assignment));
        const std::string key = assignment.substr(0, equals);
        const std::string text = assignment.substr(equals + 1);
        if (object.contains(key))
            throw InputError(fmt::format("{} \"{}\": given twice", option, key));
        object[key] = value_or_string(text);
    }
    return JsonNode::parse_text(object.dump(), option);
}

namespace {

json values_of(const ConfiguredParameters& parameters) {
    json all = json::object();
    for (const auto& [key, value] : parameters.values())
        all[key] = std::visit([](const auto& typed) { return json(typed); }, value);
    return all;
}

std::map<std::string, std::string> hashes_of(const ConfiguredParameters& parameters) {
    std::map<std::string, std::string> all;
    for (const auto& [parameter, checksum] : parameters.files_read())
        all[parameter] = hex(checksum);
    return all;
}

json identity_of(const ConfiguredParameters& parameters) {
    json all = values_of(parameters);
    for (const auto& [parameter, hash] : hashes_of(parameters)) all[parameter] = hash;
    return all;
}

}  // namespace

json describe(const Method& method) { return values_of(*method.configured); }
json describe(const IndirectMethod& method) { return values_of(*method.configured); }

std::map<std::string, std::string> files_read(const Method& method,
                                              const std::optional<IndirectMethod>& indirect) {
    std::map<std::string, std::string> all = hashes_of(*method.configured);
    if (!indirect) return all;
    for (const auto& [parameter, hash] : hashes_of(*indirect->configured))
        all["indirect_" + parameter] = hash;
    return all;
}

json identity(const Method& method) { return identity_of(*method.configured); }
json identity(const IndirectMethod& method) { return identity_of(*method.configured); }

int pass_count(const Method& method) { return method.configured->pass_count(); }

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const Method& method,
                                              const RunOptions& options, int pass) {
    return method.configured->build(scene, options, pass);
}

}  // namespace caustics::experiments

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "experiments/run/method.h"
#include "experiments/run/methods.h"

// A trial's identity holds the identities of its methods: two values of a parameter are two identities, whatever the parameter.

namespace caustics::experiments {
namespace {

using Assignments = std::vector<std::string>;

/// Settings without which a parameter has no effect.
const std::map<std::pair<std::string, std::string>, Assignments> settings_of = {
    {{"photonmap", "filter_k"}, {"filter=cone"}},
    {{"photonmap", "filter_beta"}, {"filter=gaussian"}},
    {{"photonmap", "filter_alpha"}, {"filter=gaussian", "kernel=point"}},
    {{"photonmap", "adaptive"}, {"kernel=point"}},
    {{"photonmap", "estimator"}, {"kernel=point"}},
    {{"photonmap", "tree"}, {"kernel=point"}},
    {{"beamtree", "spread_threshold"}, {"bound=hybrid"}},
    {{"beamtree", "merging"}, {"bound=hybrid"}},
    {{"beamtree", "rest_photons"}, {"rest=photons"}},
    {{"beamtree", "rest_nearest"}, {"rest=photons"}},
};

/// Two values that the parameter's help names.
std::pair<std::string, std::string> two_values(const KeyText& text) {
    if (text.type == "true or false") return {"true", "false"};
    if (text.type == "choice") {
        const std::size_t comma = text.choices.find(", ");
        const std::string first = text.choices.substr(0, comma);
        if (comma == std::string::npos) return {first, ""};  // given, and not given
        const std::size_t second = comma + 2;
        return {first, text.choices.substr(second, text.choices.find(", ", second) - second)};
    }
    if (text.choices == "above 0") return {"0.25", "0.5"};
    const double low = std::stod(text.choices);
    const double high = std::stod(text.choices.substr(text.choices.find(" to ") + 4));
    if (text.type == "whole number")
        return {fmt::format("{:.0f}", low + 1), fmt::format("{:.0f}", low + 2)};
    return {fmt::format("{}", low + (high - low) / 4), fmt::format("{}", low + (high - low) / 2)};
}

template <class Description>
std::string identity_of(const Description& description, Assignments settings,
                        const std::string& key, const std::string& value) {
    if (!value.empty()) settings.push_back(key + "=" + value);
    const JsonNode node = parameters_node(settings);
    const std::string& name = description.facts().name;
    if constexpr (std::is_same_v<Description, MethodDescription>)
        return identity(parse_method(name, node)).dump();
    else
        return identity(*parse_indirect(name, node)).dump();
}

template <class Description>
void expect_every_parameter_to_count(const Description& description) {
    const std::string& name = description.facts().name;
    for (const KeyText& text : description.parameters()) {
        SCOPED_TRACE(name + ": " + text.key);
        if (text.type == "file") continue;  // SweepPlans.TellTrialsThatLoadAFileByItsContent
        const auto found = settings_of.find({name, text.key});
        const Assignments settings = found == settings_of.end() ? Assignments() : found->second;
        const auto [one, other] = two_values(text);
        EXPECT_NE(identity_of(description, settings, text.key, one),
                  identity_of(description, settings, text.key, other))
            << one << " and " << other;
    }
}

TEST(MethodIdentity, TellsTwoValuesOfEveryParameterApart) {
    for (const MethodDescription* each : all_methods()) expect_every_parameter_to_count(*each);
    for (const IndirectDescription* each : all_indirect_methods())
        expect_every_parameter_to_count(*each);
}

}  // namespace
}  // namespace caustics::experiments

#include "experiments/verify/more_work.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

bool is_given(const std::vector<std::string>& params, const std::string& key) {
    return std::ranges::any_of(
        params, [&](const std::string& each) { return each.starts_with(key + "="); });
}

/// The parameter, or the one that stands in its place.
std::string key_of(const WorkParameter& work, const std::vector<std::string>& params) {
    return !work.instead.empty() && is_given(params, work.instead) ? work.instead : work.parameter;
}

std::vector<WorkParameter> growing(const MethodFacts& facts) {
    std::vector<WorkParameter> all;
    if (!facts.work.parameter.empty()) all.push_back(facts.work);
    all.insert(all.end(), facts.refined_with.begin(), facts.refined_with.end());
    return all;
}

std::int64_t value_of(const Method& method, const std::string& key) {
    for (const auto& [name, value] : method.configured->values())
        if (name == key)
            if (const auto* const whole = std::get_if<std::int64_t>(&value)) return *whole;
    return 0;
}

std::int64_t grown(const WorkParameter& work, const std::string& key, std::int64_t value,
                   int factor) {
    const auto more = std::llround(static_cast<double>(value) * std::pow(factor, 1.0 / work.power));
    if (value <= 0 || more > work.most)
        throw InputError(fmt::format("{}={} cannot grow to {} times the work", key, value, factor));
    return more;
}

}  // namespace

MethodAsGiven::MethodAsGiven(const std::string& name, std::vector<std::string> given)
    : method(parse_method(name, parameters_node(given))), params(std::move(given)) {}

MethodAsGiven MethodAsGiven::with_more_work(int factor) const {
    const std::vector<WorkParameter> all = growing(method.facts());
    if (all.empty())
        throw InputError(fmt::format("{} has no parameter for more work", method.name));
    std::vector<std::string> more = params;
    for (const WorkParameter& work : all) {
        const std::string key = key_of(work, params);
        const std::int64_t value = grown(work, key, value_of(method, key), factor);
        std::erase_if(more, [&](const std::string& each) { return each.starts_with(key + "="); });
        more.push_back(fmt::format("{}={}", key, value));
    }
    return {method.name, std::move(more)};
}

std::string MethodAsGiven::work_text() const {
    std::vector<std::string> texts;
    for (const WorkParameter& work : growing(method.facts())) {
        const std::string key = key_of(work, params);
        texts.push_back(fmt::format("{}={}", key, value_of(method, key)));
    }
    return fmt::format("{}", fmt::join(texts, " "));
}

}  // namespace caustics::experiments

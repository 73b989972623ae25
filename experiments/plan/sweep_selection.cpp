#include "experiments/plan/sweep_selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/near_words.h"
#include "experiments/base/bounded_json.h"
#include "experiments/base/number_option.h"

namespace caustics::experiments {

namespace {

int slurm_number(const char* name) {
    const char* const text = std::getenv(name);
    const std::optional<int> value = decimal<int>(text == nullptr ? "" : text);
    if (!value)
        throw InputError(fmt::format(
            "--shard auto: {} is {}: this is no task of a Slurm job array (give --shard i/n)", name,
            text == nullptr ? "not set" : fmt::format("\"{}\"", text)));
    return *value;
}

/// Tasks of an array with gaps, or of the middle of one (say, one task submitted again), would take
/// other trials than before.
Shard shard_of_array_task() {
    const int id = slurm_number("SLURM_ARRAY_TASK_ID");
    const int first = slurm_number("SLURM_ARRAY_TASK_MIN");
    const int last = slurm_number("SLURM_ARRAY_TASK_MAX");
    const int count = slurm_number("SLURM_ARRAY_TASK_COUNT");
    if (first < 0 || first > 1 || last - first + 1 != count || id < first || id > last)
        throw InputError(
            fmt::format("--shard auto: the array's {} tasks from {} to {} (this one: {}) do not "
                        "number n shards: "
                        "use --array=1-n or 0-(n-1), or give --shard i/n",
                        count, first, last, id));
    return {id - first + 1, count};
}

/// One spelling for a value however it is written: 1e5 as 100000, words without quotes, lists without
/// spaces.
std::string plain(const std::string& text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec == std::errc() && result.ptr == end && std::isfinite(value))
        return fmt::format("{}", value);
    const nlohmann::json parsed = parse_bounded_or_discard(text);
    if (parsed.is_string()) return parsed.get<std::string>();
    return parsed.is_discarded() ? text : parsed.dump();
}

std::map<std::string, std::string> keys_of(const Trial& trial) {
    std::map<std::string, std::string> keys = {
        {"trial", trial.id},
        {"scene", trial.scene_name},
        {"method", trial.request.method.name},
        {"seed", plain(fmt::format("{}", trial.request.seed))},
        {"repeat", plain(fmt::format("{}", trial.repeat))}};
    for (const auto& [key, value] : trial.swept) keys[key] = plain(value);
    return keys;
}

using Filters = std::map<std::string, std::set<std::string>>;

Filters values_of(const SweepPlan& plan) {
    Filters present;
    for (const Trial& trial : plan.trials)
        for (const auto& [key, value] : keys_of(trial)) present[key].insert(value);
    return present;
}

/// A filter's value: the text itself where trials have it, or else what it says; 100k says 100000.
std::string wanted_value(const std::string& key, const std::string& text, const Filters& present) {
    const auto known = present.find(key);
    if (known != present.end() && known->second.contains(text)) return text;
    if (const auto count = suffixed_count(text))
        return fmt::format("{}", static_cast<double>(*count));
    return plain(text);
}

Filters parse_filters(const std::vector<std::string>& texts, const Filters& present) {
    Filters filters;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(fmt::format("--filter \"{}\": expected key=value", text));
        const std::string key = text.substr(0, equals);
        filters[key].insert(wanted_value(key, text.substr(equals + 1), present));
    }
    return filters;
}

void require_known(const Filters& present, const Filters& filters) {
    constexpr std::size_t most_listed = 12;
    for (const auto& [key, values] : filters) {
        const auto known = present.find(key);
        if (known == present.end()) {
            std::vector<std::string> names;
            for (const auto& [name, ignored] : present) names.push_back(name);
            throw InputError(fmt::format("--filter {}: unknown key{} (known: {})", key,
                                         did_you_mean(key, names), fmt::join(names, ", ")));
        }
        std::vector<std::string> some(known->second.begin(), known->second.end());
        const bool all_listed = some.size() <= most_listed;
        if (!all_listed) some.resize(most_listed);
        for (const std::string& value : values)
            if (!known->second.contains(value))
                throw InputError(
                    fmt::format("--filter {}={}: no trial has that value{} (known: {}{})", key,
                                value, decimal<double>(value) ? "" : did_you_mean(value, some),
                                fmt::join(some, ", "), all_listed ? "" : ", ..."));
    }
}

}  // namespace

Shard parse_shard(const std::string& text) {
    if (text == "auto") return shard_of_array_task();
    const std::size_t slash = text.find('/');
    if (slash != std::string::npos) {
        const std::optional<int> index = decimal<int>(text.substr(0, slash));
        const std::optional<int> count = decimal<int>(text.substr(slash + 1));
        if (index && count && 1 <= *index && *index <= *count) return {*index, *count};
    }
    throw InputError(fmt::format("--shard {}: expected i/n with 1 <= i <= n, or auto", text));
}

void choose(SweepPlan& plan, const std::vector<std::string>& texts) {
    if (texts.empty()) return;
    const Filters present = values_of(plan);
    const Filters filters = parse_filters(texts, present);
    require_known(present, filters);
    plan.filters = texts;
    for (Trial& trial : plan.trials) {
        const std::map<std::string, std::string> keys = keys_of(trial);
        trial.chosen = std::ranges::all_of(filters, [&](const auto& filter) {
            const auto found = keys.find(filter.first);
            return found != keys.end() && filter.second.contains(found->second);
        });
    }
    if (std::ranges::none_of(plan.trials, &Trial::chosen))
        throw InputError("--filter: no trial fits all filters together");
}

std::vector<const Trial*> run_order(const SweepPlan& plan) {
    std::vector<std::tuple<int, std::uint64_t, const Trial*>> keyed;
    for (const Trial& trial : plan.trials)
        if (trial.chosen)
            keyed.emplace_back(trial.repeat, fnv1a("order " + trial.config_hash), &trial);
    std::ranges::sort(keyed);
    std::vector<const Trial*> trials;
    for (const auto& [repeat, key, trial] : keyed) trials.push_back(trial);
    return trials;
}

std::vector<const Trial*> shard_of(const std::vector<const Trial*>& trials, const Shard& shard) {
    std::vector<const Trial*> part;
    const auto step = static_cast<std::size_t>(shard.count);
    for (auto i = static_cast<std::size_t>(shard.index) - 1; i < trials.size(); i += step)
        part.push_back(trials[i]);
    return part;
}

}  // namespace caustics::experiments

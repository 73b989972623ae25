#include "experiments/plan/sweep_file.h"

#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "experiments/plan/record.h"

namespace caustics::experiments {

namespace {

constexpr std::int64_t most = 1'000'000'000;
constexpr std::int64_t most_samples = 1'000'000;  ///< as `render --spp`
constexpr std::size_t most_trials = 100'000;      ///< a plan is held in memory: 1.7 KB each
constexpr std::size_t most_keys = 100;            ///< swept together
constexpr std::size_t most_values = 1'000'000;    ///< of all keys and trials together

/// Of a product of lists of so many keys, before it is formed.
void require_few(double trials, std::size_t keys, const JsonNode& node) {
    const auto refuse = [&](const std::string& what) {
        node.fail(fmt::format("makes {} (split the sweep file)", what));
    };
    const std::string count =
        trials < 1e15 ? fmt::format("{:.0f}", trials) : fmt::format("{:.3g}", trials);
    if (keys > most_keys) refuse(fmt::format("trials of {} keys, more than {}", keys, most_keys));
    if (trials > static_cast<double>(most_trials))
        refuse(fmt::format("{} trials, more than {}", count, most_trials));
    if (trials * static_cast<double>(keys) > static_cast<double>(most_values))
        refuse(fmt::format("{} trials of {} keys, more than {} values", count, keys, most_values));
}

std::vector<JsonNode> list(const JsonNode& node) {
    std::vector<JsonNode> elements = node.as_array();
    if (elements.empty()) node.fail("an empty list makes no trials (give at least one value)");
    return elements;
}

int integer(const JsonNode& node, const std::string& key, std::int64_t low, int otherwise,
            std::int64_t high = most) {
    const std::optional<JsonNode> child = node.find(key);
    return child ? static_cast<int>(child->as_integer_in(low, high)) : otherwise;
}

std::vector<std::filesystem::path> read_scenes(const JsonNode& node) {
    std::vector<std::filesystem::path> scenes;
    for (const JsonNode& scene : list(node)) {
        const std::filesystem::path file =
            (scene.file().parent_path() / scene.as_string()).lexically_normal();
        try {
            require_regular_file(file);
        } catch (const InputError& error) {
            scene.fail(error.what());
        }
        scenes.push_back(file);
    }
    return scenes;
}

/// Of two axes for the same value, one would change nothing.
void require_own_pointer(const std::vector<SweepFile::Axis>& axes, const std::string& pointer,
                         const JsonNode& node) {
    const auto same = std::ranges::find(axes, pointer, &SweepFile::Axis::pointer);
    if (same != axes.end())
        node.fail(fmt::format("{} is what \"{}\" sets already", pointer, same->name));
}

SweepFile::Axis read_axis(const std::string& name, const JsonNode& node) {
    const bool letters =
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
    if (name.empty() || !letters)
        node.fail("becomes a column: use small letters, digits and underscores for its name");
    if (is_record_column(name) && !is_swept_column(name))
        node.fail(fmt::format("\"{}\" is a column of every trial: choose another name", name));
    SweepFile::Axis axis;
    axis.name = name;
    axis.pointer = node.at("pointer").as_string();
    for (const JsonNode& value : list(node.at("values"))) axis.values.push_back(value.canonical());
    node.finish();
    return axis;
}

std::vector<SweepFile::Axis> read_axes(const JsonNode& set) {
    const auto lists = set.others();
    require_few(1, lists.size(), set);
    std::vector<SweepFile::Axis> axes;
    for (const auto& [name, node] : lists) {
        SweepFile::Axis axis = read_axis(name, node);
        require_own_pointer(axes, axis.pointer, node.at("pointer"));
        axes.push_back(std::move(axis));
    }
    return axes;
}

/// A JSON object of the chosen parameters.
std::string object_text(const std::vector<std::pair<std::string, std::string>>& params) {
    std::string text = "{";
    for (const auto& [key, value] : params)
        text += fmt::format("{}\"{}\": {}", text.size() > 1 ? ", " : "", key, value);
    return text + "}";
}

/// A parameter that leaves a file behind is refused: the trials would overwrite each other's.
void refuse_files(const ConfiguredParameters& configured, const JsonNode& params) {
    for (const std::string& key : configured.files_written())
        params.at(key).fail(
            "not in a sweep, whose trials would overwrite each other's file (save it by the verb "
            "render, then load it here)");
}

Method method_of_trials(const std::string& name, const JsonNode& params) {
    Method method = parse_method(name, params);
    refuse_files(*method.configured, params);
    return method;
}

std::optional<IndirectMethod> indirect_of_trials(const std::string& name, const JsonNode& params) {
    std::optional<IndirectMethod> method = parse_indirect(name, params);
    if (method) refuse_files(*method->configured, params);
    return method;
}

using Params = std::vector<std::pair<std::string, std::string>>;

/// All combinations of a method's parameter lists, the last key varying fastest.
std::vector<Params> combinations(const std::optional<JsonNode>& params) {
    std::vector<Params> cases(1);
    if (!params) return cases;
    const auto lists = params->others();
    for (const auto& [key, value] : lists) {
        const std::vector<JsonNode> choices =
            value.is_array() ? list(value) : std::vector<JsonNode>{value};
        require_few(static_cast<double>(cases.size()) * static_cast<double>(choices.size()),
                    lists.size(), *params);
        std::vector<Params> product;
        for (const Params& so_far : cases)
            for (const JsonNode& choice : choices) {
                product.push_back(so_far);
                product.back().emplace_back(key, choice.canonical());
            }
        cases = std::move(product);
    }
    return cases;
}

/// Parameters as the node that they came from.
JsonNode node_of(const std::string& object, const std::optional<JsonNode>& params,
                 const JsonNode& method) {
    return JsonNode::parse_text(object, params ? params->place() : method.place(), method.file());
}

std::string read_name(const JsonNode& node, const std::vector<std::string>& known) {
    return known[node.at("method").as_choice(known)];
}

/// Counts that the file writes as text ("100k") become the numbers that the method read, as which they are columns.
void resolve_counts(const ConfiguredParameters& configured, Params& params) {
    for (const auto& [key, value] : configured.values()) {
        const auto written = std::ranges::find(params, key, &Params::value_type::first);
        const auto* const count = std::get_if<std::int64_t>(&value);
        if (count != nullptr && written != params.end() && written->second.starts_with('"'))
            written->second = fmt::format("{}", *count);
    }
}

const ConfiguredParameters* configured_of(const Method& method) { return method.configured.get(); }
const ConfiguredParameters* configured_of(const std::optional<IndirectMethod>& method) {
    return method ? method->configured.get() : nullptr;
}

/// The cases of a method's entry; `parse(name, params)` makes one.
template <typename Case, typename Parse>
std::vector<Case> read_cases(const JsonNode& node, const std::vector<std::string>& known,
                             const Parse& parse) {
    const std::string name = read_name(node, known);
    const std::optional<JsonNode> params = node.find("param");
    std::vector<Case> cases;
    for (Params& each : combinations(params)) {
        cases.push_back({parse(name, node_of(object_text(each), params, node)), each});
        if (const auto* const configured = configured_of(cases.back().method))
            resolve_counts(*configured, cases.back().params);
    }
    node.finish();
    return cases;
}

/// Parameters that are no lists, of a method's entry.
JsonNode single_params(const JsonNode& node) {
    const std::optional<JsonNode> params = node.find("param");
    if (params) params->others();
    return node_of(params ? params->canonical() : "{}", params, node);
}

SweepFile::Reference read_reference(const JsonNode& node, int sweep_spp) {
    SweepFile::Reference reference;
    reference.method = method_of_trials(read_name(node, method_names()), single_params(node));
    if (const std::optional<JsonNode> indirect = node.find("indirect")) {
        reference.indirect =
            indirect_of_trials(read_name(*indirect, indirect_names()), single_params(*indirect));
        indirect->finish();
    }
    reference.spp = integer(node, "spp", 1, std::max(64, sweep_spp), most_samples);
    reference.seed = static_cast<std::uint64_t>(integer(node, "seed", 0, 1));
    node.finish();
    return reference;
}

double count_trials(const SweepFile& sweep) {
    double trials = sweep.repeats;
    for (const SweepFile::Axis& axis : sweep.axes)
        trials *= static_cast<double>(axis.values.size());
    for (const std::size_t factor :
         {sweep.scenes.size(), sweep.methods.size(), sweep.indirect.size(), sweep.seeds.size()})
        trials *= static_cast<double>(factor);
    return trials;
}

/// Pictures with light between surfaces are scored against one that has it.
void require_same_layers(const SweepFile& sweep, const JsonNode& node) {
    const bool has_indirect = std::ranges::any_of(
        sweep.indirect, [](const auto& each) { return each.method.has_value(); });
    if (has_indirect && sweep.reference && !sweep.reference->indirect)
        node.at("reference")
            .fail("has no indirect light, which the trials have: give it \"indirect\", too");
}

}  // namespace

SweepFile read_sweep_file(const std::filesystem::path& file) {
    const JsonNode node = JsonNode::parse_file(file);
    SweepFile sweep;
    sweep.file = file;
    node.at("version").as_integer_in(1, 1);
    sweep.scenes = read_scenes(node.at("scenes"));
    if (const std::optional<JsonNode> set = node.find("set")) sweep.axes = read_axes(*set);
    for (const JsonNode& method : list(node.at("methods")))
        for (SweepFile::MethodCase& each :
             read_cases<SweepFile::MethodCase>(method, method_names(), method_of_trials))
            sweep.methods.push_back(std::move(each));
    if (const std::optional<JsonNode> indirect = node.find("indirect")) {
        sweep.indirect.clear();
        for (const JsonNode& method : list(*indirect))
            for (SweepFile::IndirectCase& each :
                 read_cases<SweepFile::IndirectCase>(method, indirect_names(), indirect_of_trials))
                sweep.indirect.push_back(std::move(each));
    }
    if (const std::optional<JsonNode> seeds = node.find("seeds")) {
        for (const JsonNode& seed : list(*seeds))
            sweep.seeds.push_back(
                static_cast<std::uint64_t>(seed.as_integer_in(0, 1'000'000'000'000'000)));
    } else {
        sweep.seeds = {1};
    }
    sweep.repeats = integer(node, "repeats", 1, 1);
    sweep.spp = integer(node, "spp", 1, 16, most_samples);
    sweep.threads = integer(node, "threads", 1, 1, most_threads);
    if (const std::optional<JsonNode> reference = node.find("reference"))
        sweep.reference = read_reference(*reference, sweep.spp);
    require_same_layers(sweep, node);
    node.finish();
    require_few(count_trials(sweep), sweep.axes.size(), node);
    return sweep;
}

}  // namespace caustics::experiments

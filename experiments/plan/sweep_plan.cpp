#include "experiments/plan/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/plan/record.h"
#include "experiments/plan/reference_cache.h"
#include "experiments/plan/sweep_file.h"
#include "experiments/run/cli_options.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;
using Assignments = std::vector<std::pair<std::string, std::string>>;

/// A scene under one combination of the swept values.
struct SceneVariant {
    std::filesystem::path file;
    Overrides overrides;
    Assignments swept;
    std::string hash;
    std::optional<ReferenceRequest> reference;
};

std::vector<SceneVariant> variants(const SweepFile& sweep) {
    std::vector<SceneVariant> all;
    for (const std::filesystem::path& scene : sweep.scenes) all.push_back({scene, {}, {}, {}, {}});
    for (const SweepFile::Axis& axis : sweep.axes) {
        std::vector<SceneVariant> product;
        for (const SceneVariant& so_far : all)
            for (const std::string& value : axis.values) {
                product.push_back(so_far);
                product.back().overrides.emplace_back(axis.pointer, value);
                product.back().swept.emplace_back(axis.name, value);
            }
        all = std::move(product);
    }
    // Whatever the columns' names, /water comes before /water/resolution, which is in it.
    for (SceneVariant& variant : all) std::ranges::sort(variant.overrides);
    return all;
}

/// "sweep.json: /set/alpha: 7: " for the value that the scene cannot be loaded with, or
/// "sweep.json: /scenes: " when it cannot be loaded anyway.
std::string place_of_mistake(const SweepFile& sweep, const SceneVariant& variant) {
    const std::string file = sweep.file.string();
    Overrides so_far;
    for (const auto& next : variant.overrides) {
        try {
            load_scene(variant.file, so_far);
        } catch (const InputError&) {
            break;
        }
        so_far.push_back(next);
    }
    if (so_far.empty()) return fmt::format("{}: /scenes: ", file);
    const auto& [pointer, value] = so_far.back();
    const auto axis = std::ranges::find(sweep.axes, pointer, &SweepFile::Axis::pointer);
    return fmt::format("{}: /set/{}: {}: ", file, axis->name, value);
}

SceneFile load(const SweepFile& sweep, const SceneVariant& variant) {
    try {
        return load_scene(variant.file, variant.overrides);
    } catch (const InputError& error) {
        throw InputError(place_of_mistake(sweep, variant) + error.what());
    }
}

/// What loading the variant gives: {"hash", "reference_key"}. Loads it as trials will, so that
/// whatever is wrong shows before anything runs.
json examine(const SweepFile& sweep, const SceneVariant& variant) {
    SceneFile file = load(sweep, variant);
    const auto place = [&](const char* key) {
        return fmt::format("{}: {}: for {}:", sweep.file.string(), key, variant.file.string());
    };
    samples_per_pixel(file.desc.sampling, sweep.spp, place("/spp"));
    json facts = {{"hash", file.hash}};
    if (!variant.reference) return facts;
    const RunRequest& request = variant.reference->request;
    PixelSampling fixed_rate = file.desc.sampling;
    fixed_rate.max_sample_count = 0;
    samples_per_pixel(fixed_rate, request.samples_per_pixel, place("/reference/spp"));
    const Scene scene(take_shapes(file));
    const auto require = [&](const std::optional<std::string>& reason) {
        if (reason)
            throw UnsupportedScene(fmt::format("{}: /reference: for {}: {}", sweep.file.string(),
                                               variant.file.string(), *reason));
    };
    require(why_unsupported(scene, request.method));
    if (request.indirect) require(why_unsupported(scene, *request.indirect));
    facts["reference_key"] = reference_key(request, file, reference_version(scene));
    return facts;
}

void ask_for_reference(const SweepFile& sweep, SceneVariant& variant) {
    if (!sweep.reference) return;
    ReferenceRequest reference;
    reference.request = {variant.file,          variant.overrides,    sweep.reference->method,
                         sweep.reference->seed, sweep.reference->spp, sweep.reference->indirect};
    reference.kept_folder = kept_references(sweep.file);
    variant.reference = reference;
}

void resolve(const SweepFile& sweep, std::vector<SceneVariant>& all, const Isolation& isolation) {
    for (SceneVariant& variant : all) ask_for_reference(sweep, variant);
    const json facts = json::parse(isolation([&] {
        json found = json::array();
        for (const SceneVariant& variant : all) found.push_back(examine(sweep, variant));
        return found.dump();
    }));
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].hash = facts[i].at("hash").get<std::string>();
        if (all[i].reference)
            all[i].reference->key = facts[i].at("reference_key").get<std::string>();
    }
}

std::string slug_word(const std::string& text) {
    std::string word;
    for (const char c : text)
        if (c != '"') word += std::isalnum(static_cast<unsigned char>(c)) || c == '.' ? c : '_';
    return word;
}

/// For people to read; what distinguishes trials is the hash behind it.
std::string slug(const Trial& trial) {
    constexpr std::size_t longest = 100;
    std::string words = slug_word(trial.scene_name) + "-" + trial.request.method.name;
    for (const auto& [key, value] : trial.swept)
        words += fmt::format("-{}{}", slug_word(key), slug_word(value));
    if (trial.request.indirect) words += "-" + trial.request.indirect->name;
    words.resize(std::min(words.size(), longest));
    if (words[0] == '.' || words[0] == '-') words[0] = '_';  // no hidden folder, and no option
    words += fmt::format("-s{}", trial.request.seed);
    if (trial.repeat > 1) words += fmt::format("-r{}", trial.repeat);
    return words;
}

/// What the trials of a cell share.
json configuration_of(const Trial& trial) {
    json all = {{"record_version", record_version},
                {"scene", trial.scene_hash},
                {"method", trial.request.method.name},
                {"parameters", identity(trial.request.method)},
                {"spp", trial.request.samples_per_pixel},
                {"reference", trial.reference ? trial.reference->key : ""}};
    if (const auto& indirect = trial.request.indirect) {
        all["indirect"] = indirect->name;
        all["indirect_parameters"] = identity(*indirect);
    }
    return all;
}

/// Names a trial of the cell of that configuration.
void identify(Trial& trial, json& configuration) {
    configuration["seed"] = trial.request.seed;
    configuration["repeat"] = trial.repeat;
    trial.config_hash = hex(fnv1a(configuration.dump()));
    trial.id = slug(trial) + "-" + trial.config_hash;
}

Trial make_trial(const SweepFile& sweep, const SceneVariant& variant,
                 const SweepFile::MethodCase& method, const SweepFile::IndirectCase& indirect) {
    Trial trial;
    trial.request = {variant.file, variant.overrides, method.method, 1, sweep.spp, indirect.method};
    trial.threads = sweep.threads;
    trial.scene_name = variant.file.stem().string();
    trial.scene_hash = variant.hash;
    trial.method_files = files_read(method.method, indirect.method);
    trial.swept = variant.swept;
    trial.swept.insert(trial.swept.end(), method.params.begin(), method.params.end());
    for (const auto& [key, value] : indirect.params)
        trial.swept.emplace_back("indirect_" + key, value);
    trial.reference = variant.reference;
    trial.cell = hex(fnv1a(configuration_of(trial).dump()));
    return trial;
}

// The trial with every seed, repeated.
void add_cell(const SweepFile& sweep, const Trial& first, SweepPlan& plan,
              std::set<std::string>& known) {
    json configuration = configuration_of(first);
    for (const std::uint64_t seed : sweep.seeds)
        for (int repeat = 1; repeat <= sweep.repeats; ++repeat) {
            Trial trial = first;
            trial.request.seed = seed;
            trial.repeat = repeat;
            identify(trial, configuration);
            if (known.insert(trial.config_hash).second)
                plan.trials.push_back(std::move(trial));
            else
                ++plan.duplicates;
        }
}

void add_trials(const SweepFile& sweep, SweepPlan& plan, std::set<std::string>& known,
                const Isolation& isolation) {
    std::vector<SceneVariant> scenes = variants(sweep);
    resolve(sweep, scenes, isolation);
    for (const SceneVariant& variant : scenes)
        for (const SweepFile::MethodCase& method : sweep.methods)
            for (const SweepFile::IndirectCase& indirect : sweep.indirect)
                add_cell(sweep, make_trial(sweep, variant, method, indirect), plan, known);
}

void add_columns(const SweepPlan& plan, std::vector<std::string>& columns) {
    for (const Trial& trial : plan.trials)
        for (const auto& [key, value] : trial.swept)
            if (std::ranges::count(columns, key) == 0) columns.push_back(key);
}

/// The columns of a sweep's parameters.
std::set<std::string> parameter_columns(const SweepFile& sweep) {
    std::set<std::string> columns;
    for (const SweepFile::MethodCase& each : sweep.methods)
        for (const auto& [key, value] : each.params) columns.insert(column_of_swept(key));
    for (const SweepFile::IndirectCase& each : sweep.indirect)
        for (const auto& [key, value] : each.params) columns.insert("indirect_" + key);
    return columns;
}

/// All files make one table: an axis of a scene would have the column of a parameter that its methods are given, here or in
/// another file.
void require_own_columns(const std::vector<SweepFile>& sweeps) {
    std::map<std::string, std::set<std::string>> parameters;  // of a scene's trials
    for (const SweepFile& sweep : sweeps)
        for (const std::filesystem::path& scene : sweep.scenes)
            parameters[scene.stem().string()].merge(parameter_columns(sweep));
    for (const SweepFile& sweep : sweeps)
        for (const SweepFile::Axis& axis : sweep.axes)
            for (const std::filesystem::path& scene : sweep.scenes)
                if (parameters[scene.stem().string()].contains(axis.name))
                    throw InputError(fmt::format(
                        "{}: /set/{}: \"{}\" is the column of a method's parameter: choose another "
                        "name",
                        sweep.file.string(), axis.name, axis.name));
}

/// A table knows scenes by the names of their files.
void require_own_names(const std::vector<SweepFile>& sweeps) {
    std::map<std::string, std::filesystem::path> files;
    for (const SweepFile& sweep : sweeps)
        for (const std::filesystem::path& scene : sweep.scenes) {
            const auto [first, is_new] = files.emplace(scene.stem().string(), scene);
            std::error_code unknown;
            if (!is_new && !std::filesystem::equivalent(first->second, scene, unknown) && !unknown)
                throw InputError(fmt::format(
                    "{}: /scenes: {} and {} have one name, by which tables know them: rename one",
                    sweep.file.string(), first->second.string(), scene.string()));
        }
}

}  // namespace

std::filesystem::path kept_references(const std::filesystem::path& sweep_file) {
    return (std::filesystem::absolute(sweep_file).parent_path().parent_path() / "references")
        .lexically_normal();
}

SweepPlan read_plan(const std::vector<std::filesystem::path>& files, const Isolation& isolation) {
    SweepPlan plan;
    plan.files = files;
    std::vector<SweepFile> sweeps;
    for (const std::filesystem::path& file : files) sweeps.push_back(read_sweep_file(file));
    require_own_columns(sweeps);
    require_own_names(sweeps);
    std::set<std::string> known;
    for (const SweepFile& sweep : sweeps) add_trials(sweep, plan, known, isolation);
    add_columns(plan, plan.swept);
    return plan;
}

}  // namespace caustics::experiments

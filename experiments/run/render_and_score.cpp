#include "experiments/run/render_and_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "experiments/base/environment.h"
#include "experiments/base/shell_word.h"
#include "experiments/run/mesh_notes.h"
#include "experiments/run/notes.h"
#include "experiments/run/why_empty.h"

namespace caustics::experiments {

namespace {

/// Passes follow each other: counts and light add up, memory and parameters chosen are those of the largest.
void add(BuildReport& report, const BuildReport& pass) {
    report.bytes = std::max(report.bytes, pass.bytes);
    for (const auto& [name, count] : pass.counters) report.counters[name] += count;
    for (const auto& [name, value] : pass.resolved)
        report.resolved[name] = std::max(report.resolved[name], value);
    if (!pass.light) return;
    if (!report.light) report.light.emplace();
    report.light->add(*pass.light);
}

std::string parameter_words(const std::string& option, const nlohmann::json& parameters) {
    std::string words;
    for (const auto& [key, value] : parameters.items())
        words += fmt::format(
            " {} {}", option,
            shell_word(key + "=" + (value.is_string() ? value.get<std::string>() : value.dump())));
    return words;
}

// Counters and values under names of their own.
BuildReport of_indirect(const BuildReport& own) {
    BuildReport report;
    report.bytes = own.bytes;
    add_under("indirect_", own.counters, report.counters);
    for (const auto& [name, value] : own.resolved) report.resolved["indirect_" + name] = value;
    return report;
}

std::optional<CausticLedger> ledger_of(const Scene& scene, const Method& method,
                                       const BuildReport& report, const Rendering& rendering,
                                       int threads, Telling telling) {
    if (telling == Telling::nothing) return {};
    std::optional<CausticLedger> ledger = caustic_ledger(scene, method, report);
    if (!ledger) return {};
    const auto photons = report.counters.find("photons_stored");
    ledger->picture =
        picture_light(scene, rendering, method,
                      photons == report.counters.end() ? 0.0 : static_cast<double>(photons->second),
                      threads, telling == Telling::of_few_paths);
    return ledger;
}

}  // namespace

std::string command(const std::string& verb, const RunRequest& request) {
    std::string line = fmt::format("causticbench {} {}", verb, shell_path(request.scene_file));
    if (request.method.configured) line += " --method " + request.method.name;
    for (const auto& [pointer, value] : request.overrides)
        line += " --set " + shell_word(pointer + "=" + value);
    if (request.method.configured)
        line += parameter_words("--param", describe(request.method));
    else
        line += " --layer indirect";
    if (request.indirect)
        line += " --indirect " + request.indirect->name +
                parameter_words("--indirect-param", describe(*request.indirect));
    if (verb == "render") line += fmt::format(" --spp {}", request.samples_per_pixel);
    if (request.telling == Telling::of_few_paths) line += " --few-light-paths";
    return line + fmt::format(" --seed {}", request.seed);
}

SceneDesc take_shapes(SceneFile& file) {
    std::vector<Shape> shapes = std::move(file.desc.shapes);
    file.desc.shapes.clear();
    SceneDesc desc = file.desc;
    desc.shapes = std::move(shapes);
    return desc;
}

std::map<std::string, std::string> picture_metadata(const RunRequest& request,
                                                    const SceneFile& scene,
                                                    const RunResult& result) {
    const BuildReport& report = result.report;
    nlohmann::json assets = nlohmann::json::object();
    for (const auto& [name, hash] : scene.assets) assets[name] = hash;
    std::map<std::string, std::string> metadata = {
        {"scene", scene.canonical},
        {"scene_assets", assets.dump()},
        {"scene_hash", scene.hash},
        {"method", request.method.name},
        {"parameters", describe(request.method).dump()},
        {"seed", fmt::format("{}", request.seed)},
        {"spp", fmt::format("{}", request.samples_per_pixel)},
        {"code_version", code_version()},
        {"command", command("render", request)}};
    for (const auto& [parameter, hash] : files_read(request.method, request.indirect))
        metadata[parameter + "_hash"] = hash;
    if (request.indirect) {
        metadata["indirect"] = request.indirect->name;
        metadata["indirect_parameters"] = describe(*request.indirect).dump();
    }
    if (result.ledger) metadata["light"] = to_json(*result.ledger).dump();
    if (!report.resolved.empty()) metadata["resolved"] = nlohmann::json(report.resolved).dump();
    return metadata;
}

RunResult run(const Scene& scene, const RunRequest& request, RunOptions options,
              Stopwatch& stopwatch) {
    options.seed = request.seed;
    options.samples_per_pixel = request.samples_per_pixel;
    options.origin = command("render", request);
    std::string stage;
    const auto on_phase = options.begin_phase;
    const auto begin_stage = [&](const char* name) {
        stage = name;
        stopwatch.begin(stage);
        if (on_phase) on_phase(stage);
    };
    options.begin_phase = [&](std::string_view phase) {
        stopwatch.begin(fmt::format("{}/{}", stage, phase));
        if (on_phase) on_phase(phase);
    };

    BuildReport report;
    const auto build_pass = [&](int pass) {
        begin_stage("precompute");
        auto built = build(scene, request.method, options, pass);
        add(report, built->build_report());
        begin_stage("render");
        return built;
    };
    std::unique_ptr<const IndirectEstimator> indirect;
    if (request.indirect) {
        begin_stage("indirect");
        indirect = request.indirect->configured->build(scene, options, 0);
        const BuildReport own = of_indirect(indirect->build_report());
        add(report, own);
    }
    Rendering rendering =
        render(scene, {pass_count(request.method), build_pass, request.pixel_step}, options,
               indirect.get());
    stopwatch.stop();

    if (report.light) report.light = report.light->scaled(1.0 / pass_count(request.method));
    if (rendering.report.light) report.light = rendering.report.light;
    BuildReport all = report;
    for (const auto& [name, count] : rendering.report.counters) all.counters[name] += count;
    auto ledger =
        ledger_of(scene, request.method, all, rendering, options.threads, request.telling);
    RunResult result{std::move(rendering.film), std::move(report), all.counters, {}, {}, {},
                     std::move(ledger)};
    if (request.telling == Telling::nothing) return result;
    result.notes = notes(scene, request.method, all, result.ledger);
    std::ranges::copy(notes_on_picture(request.method, request.indirect, options),
                      std::back_inserter(result.notes));
    if (request.indirect)
        std::ranges::copy(notes_on_indirect(scene), std::back_inserter(result.notes));
    result.mesh_notes = mesh_notes(scene);
    std::ranges::copy(result.mesh_notes, std::back_inserter(result.notes));
    std::ranges::copy(notes_on(scene), std::back_inserter(result.notes));
    result.why_empty =
        why_empty(scene, request.method, result.film, result.report, result.counters);
    return result;
}

}  // namespace caustics::experiments

#include "experiments/plan/trial.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/base/environment.h"
#include "experiments/base/machine_load.h"
#include "experiments/picture/metrics.h"
#include "experiments/plan/record.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

json seconds_json(const Seconds& seconds) { return {{"wall", seconds.wall}, {"cpu", seconds.cpu}}; }

bool starts_with(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

/// Stages that follow each other and add up to the total: parse, precompute (without balance),
/// balance, render; beside them every phase as the method named it.
void record_seconds(json& record, const Stopwatch& stopwatch) {
    Seconds precompute;
    Seconds indirect;
    Seconds render;
    Seconds total;
    json phases = json::object();
    for (const auto& [name, seconds] : stopwatch.phases()) {
        total += seconds;
        phases[name] = seconds_json(seconds);
        if (name == "precompute/balance") continue;
        if (starts_with(name, "precompute")) precompute += seconds;
        if (starts_with(name, "indirect")) indirect += seconds;
        if (starts_with(name, "render")) render += seconds;
    }
    json stages = {{"parse", seconds_json(stopwatch.of("parse"))},
                   {"precompute", seconds_json(precompute)},
                   {"render", seconds_json(render)},
                   {"total", seconds_json(total)}};
    if (stopwatch.phases().contains("indirect")) stages["indirect"] = seconds_json(indirect);
    if (stopwatch.phases().contains("precompute/balance"))
        stages["balance"] = seconds_json(stopwatch.of("precompute/balance"));
    record["seconds"] = std::move(stages);
    record["phases"] = std::move(phases);
}

void record_scene(json& record, const SceneFile& file, const Scene& scene) {
    std::size_t polygons = 0;
    for (const std::uint32_t caster : scene.casters())
        polygons += triangle_count(scene.shapes()[caster]);
    if (polygons > 0) record["scene"]["polygons"] = polygons;
    record["scene"]["resolved"] = json::parse(file.canonical);
    for (const auto& [name, hash] : file.assets) record["scene"]["assets"][name] = hash;
}

void record_report(json& record, const RunResult& result) {
    for (const auto& [name, count] : result.counters) record["counters"][name] = count;
    for (const auto& [name, value] : result.report.resolved)
        record["method"]["resolved"][name] = value;
    if (!result.notes.empty()) record["notes"] = result.notes;
    if (!result.mesh_notes.empty())
        record["scene"]["mesh_flaws"] = fmt::format("{}", fmt::join(result.mesh_notes, "; "));
    if (result.report.bytes > 0) record["memory"]["map_bytes"] = result.report.bytes;
    if (result.why_empty) record["why_empty"] = *result.why_empty;
    if (result.ledger) record["light"] = to_json(*result.ledger);
}

/// Of all planes of a picture, names included: the same picture has the same hash.
std::string picture_hash(const Film& film) {
    std::uint64_t hash = fnv1a(fmt::format("{} {}", film.width(), film.height()));
    for (const Plane& plane : film.planes()) {
        hash = fnv1a(plane.channel, hash);
        hash = fnv1a({reinterpret_cast<const char*>(plane.values.data()),
                      plane.values.size() * sizeof(float)},
                     hash);
    }
    return hex(hash);
}

/// Not the trial's own fault: it is left to do.
class LeftToDo : public InputError {
public:
    using InputError::InputError;
};

/// The trial itself; what it knows when it throws is in the record and the log.
void execute(const Trial& trial, const Reference* reference, RunOptions options,
             const TrialLog& write, TrialOutcome& outcome) {
    json& record = outcome.record;
    Stopwatch stopwatch;
    const auto log = [&](std::string_view what) {
        write(fmt::format("{:10.3f} s  {}", stopwatch.total().wall, what));
    };
    options.begin_phase = [&](std::string_view phase) { log(phase); };

    const MachineLoad load;
    reset_peak_resident_bytes();
    record["memory"]["rss_start_bytes"] = resident_bytes();
    log("parse");
    stopwatch.begin("parse");
    SceneFile file = load_scene(trial.request.scene_file, trial.request.overrides);
    if (file.hash != trial.scene_hash)
        throw LeftToDo(
            fmt::format("{}: changed while the sweep runs", trial.request.scene_file.string()));
    if (files_read(trial.request.method, trial.request.indirect) != trial.method_files)
        throw LeftToDo("a file that a parameter names changed while the sweep runs");
    const Scene scene(take_shapes(file));
    record_scene(record, file, scene);
    log("precompute and render");
    RunResult result = run(scene, trial.request, options, stopwatch);
    record["memory"]["peak_rss_bytes"] = peak_resident_bytes();
    record["load"] = load.record();
    record_seconds(record, stopwatch);
    record_report(record, result);
    if (result.why_empty) log("the caustic is empty: " + *result.why_empty);
    for (const std::string& note : result.notes) log("note: " + note);

    log("measure");
    require_finite(result.film, "the picture");
    if (reference != nullptr) record_errors(record, result.film, *reference);
    result.film.metadata = picture_metadata(trial.request, file, result);
    record["picture_hash"] = picture_hash(result.film);
    outcome.film = std::move(result.film);
    record["status"] = "done";
    log("done");
}

}  // namespace

void record_errors(json& record, const Film& film, const Reference& reference) {
    const PixelMask reached = reached_pixels(film, reference.film);
    const PixelMask bright = bright_pixels(reference.film, "caustic", reached);
    for (const char* earlier : {"mean", "stderr", "indirect_mean", "indirect_stderr", "why_empty"})
        record["reference"].erase(earlier);
    for (const char* earlier : {"indirect_metrics", "flip"}) record.erase(earlier);
    record["metrics"] = to_json(measure(film, reference.film, "caustic", reached));
    record["mask_metrics"] = to_json(measure(film, reference.film, "caustic", bright));
    record["mask_fraction"] = fraction(bright);
    record["beauty_rmse"] = to_json(measure(film, reference.film, "", reached))["rmse"];
    record["unreached_fraction"] = 1 - fraction(reached);
    record["reference"]["mean"] = reference.caustic.mean;
    if (const auto& error = reference.caustic.standard_error)
        record["reference"]["stderr"] = *error;
    if (film.has_layer("indirect") && reference.indirect) {
        record["indirect_metrics"] = to_json(measure(film, reference.film, "indirect", reached));
        record["reference"]["indirect_mean"] = reference.indirect->mean;
        if (const auto& error = reference.indirect->standard_error)
            record["reference"]["indirect_stderr"] = *error;
    }
    const auto empty = reference.film.metadata.find("why_empty");
    if (empty != reference.film.metadata.end()) record["reference"]["why_empty"] = empty->second;
}

json trial_record(const Trial& trial, const std::string& status, const RunOptions& options) {
    json record = {{"version", record_version},
                   {"trial", trial.id},
                   {"status", status},
                   {"seed", trial.request.seed},
                   {"repeat", trial.repeat},
                   {"threads", options.threads},
                   {"isa", name(options.isa)},
                   {"spp", trial.request.samples_per_pixel},
                   {"config_hash", trial.config_hash},
                   {"code_version", code_version()},
                   {"machine", {{"host", host_name()}, {"cpu", cpu_name()}}}};
    record["scene"] = {{"name", trial.scene_name},
                       {"file", trial.request.scene_file.string()},
                       {"hash", trial.scene_hash}};
    for (const auto& [pointer, value] : trial.request.overrides)
        record["scene"]["set"][pointer] = value;
    record["method"] = {{"name", trial.request.method.name},
                        {"parameters", describe(trial.request.method)}};
    if (!trial.method_files.empty()) record["method"]["files"] = trial.method_files;
    if (const auto& indirect = trial.request.indirect)
        record["indirect"] = {{"name", indirect->name}, {"parameters", describe(*indirect)}};
    record["swept"] = json::object();
    for (const auto& [key, value] : trial.swept) record["swept"][key] = json::parse(value);
    if (!trial.reference) return record;
    const ReferenceRequest& reference = *trial.reference;
    record["reference"] = {
        {"name", fmt::format("{}:{}", reference.request.method.name, reference.key)},
        {"key", reference.key},
        {"parameters", describe(reference.request.method)},
        {"spp", reference.request.samples_per_pixel},
        {"seed", reference.request.seed}};
    return record;
}

TrialOutcome run_trial(const Trial& trial, ReferenceCache& references, const RunOptions& options,
                       const TrialLog& log) {
    TrialOutcome outcome{trial_record(trial, "failed", options), {}};
    const auto end_with = [&](const char* status, const std::string& message) {
        outcome.record["status"] = status;
        outcome.record["message"] = message;
        log(fmt::format("{}: {}", status, message));
    };
    std::shared_ptr<const Reference> reference;
    try {
        if (trial.reference) reference = references.get(*trial.reference);
    } catch (const std::exception& error) {
        end_with("left", fmt::format("reference: {}", error.what()));
        return outcome;
    }
    try {
        execute(trial, reference.get(), options, log, outcome);
    } catch (const UnsupportedScene& error) {
        end_with("unsupported", error.what());
    } catch (const LeftToDo& error) {
        end_with("left", error.what());
    } catch (const std::bad_alloc&) {
        end_with("failed", "out of memory");
    } catch (const std::exception& error) {
        end_with("failed", error.what());
    }
    return outcome;
}

}  // namespace caustics::experiments

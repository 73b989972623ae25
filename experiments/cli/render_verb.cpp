#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/error.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/base/signals.h"
#include "experiments/cli/verbs.h"
#include "experiments/picture/metrics.h"
#include "experiments/picture/previews.h"
#include "experiments/run/cli_options.h"
#include "experiments/run/render_and_score.h"
#include "experiments/run/run_progress.h"
#include "experiments/run/time_budget.h"
#include "experiments/run/written_files.h"

namespace caustics::experiments {

namespace {

/// Reaches every float from its smallest to its largest.
constexpr double most_stops = 150;

struct RenderOptions {
    SceneOptions scene;
    MethodOptions method;
    IndirectOptions indirect;
    RunFlags run;
    int spp = 0;
    std::optional<double> exposure;
    std::optional<double> seconds;  ///< that the picture is to take
    std::string work;               ///< the scene's number that takes them; empty: the method's
    std::vector<std::string> outputs;
};

void check_outputs(const std::vector<std::string>& outputs) {
    for (const std::string& output : outputs) {
        if (output == "-")
            throw InputError(
                "-o -: pictures are not written to standard output (give a file: "
                ".exr, .png)");
        const std::string ending = std::filesystem::path(output).extension().string();
        if (ending != ".exr" && ending != ".png")
            throw InputError(fmt::format(
                "-o {}: unknown kind of picture \"{}\" (known: .exr, .png)", output, ending));
        require_writable_place(output);
    }
}

/// What became of light paths and of the camera's, as far as the method counted.
std::string told_counts(const Counters& counters) {
    std::string text;
    const auto tell = [&](const char* what, const char* name) {
        const auto found = counters.find(name);
        if (found == counters.end()) return;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", found->second, what);
    };
    tell("light paths", "photons_emitted");
    tell("aimed", "photons_aimed");
    tell("reflections", "photons_reflected");
    tell("refractions", "photons_refracted");
    tell("photons stored", "photons_stored");
    tell("connected to the camera", "photons_connected");
    tell("beams", "beams");
    tell("receiver points seen", "receiver_points");
    tell("lit", "lit_points");
    tell("shadow rays", "shadow_rays");
    tell("spared by shadow photons", "shadow_rays_saved");
    return text;
}

/// A picture with all that is told of it.
struct Picture {
    RunRequest request;
    SceneFile file;  ///< without its shapes
    RunResult result;
    Seconds took;  ///< building and rendering
};

Picture picture_of(const RenderOptions& options) {
    SceneFile file = options.scene.load();
    RunRequest request{options.scene.file,
                       options.scene.overrides(),
                       options.method.parse(),
                       options.run.seed,
                       samples_per_pixel(file.desc.sampling, options.spp),
                       options.indirect.parse()};
    require_files_apart(options.outputs, request, file.files);
    const Scene scene(std::move(file.desc));  // a copy of large meshes takes seconds
    Stopwatch stopwatch;
    RunOptions run_options = options.run.options(request.samples_per_pixel);
    const RunProgress progress(run_options, pass_count(request.method));
    RunResult result = run(scene, request, run_options, stopwatch);
    return {std::move(request), std::move(file), std::move(result), stopwatch.worked()};
}

/// What the time of --seconds goes into.
WorkParameter work_parameter(const RenderOptions& options) {
    constexpr std::int64_t most_of_scene = 4096;
    if (!options.work.empty())
        return {.parameter = options.work, .power = 2, .first = 8, .most = most_of_scene};
    const WorkParameter work = options.method.parse().facts().work;
    if (work.parameter.empty())
        throw InputError(fmt::format(
            "--seconds: {} has no parameter that could take them (take another method, or name a "
            "number of the scene by --work)",
            options.method.name));
    for (const std::string& param : options.method.params)
        if (param.starts_with(work.parameter + "="))
            throw InputError(
                fmt::format("--seconds chooses {}: leave --param {} out", work.parameter, param));
    return work;
}

bool is_whole(const nlohmann::json& value) {
    if (value.is_number_integer()) return true;
    return value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>();
}

/// Refuses a value of the scene that whole numbers do not stand for; one that is not there may be set.
void require_whole_work(const RenderOptions& options) {
    if (options.work.empty() || options.work[0] != '/') return;
    const auto scene = nlohmann::json::parse(options.scene.load().canonical);
    const nlohmann::json* value = nullptr;
    try {
        value = &scene.at(nlohmann::json::json_pointer(options.work));
    } catch (const nlohmann::json::exception&) {
        return;
    }
    if (is_whole(*value)) return;
    const std::string held = value->is_object()  ? "an object"
                             : value->is_array() ? "an array"
                                                 : value->dump();
    throw InputError(
        fmt::format("--work {}: holds {}, which is no whole number", options.work, held));
}

/// Whether more work made no difference: neither in the picture nor in what was counted.
bool are_same(const RunResult& a, const RunResult& b) {
    return a.counters == b.counters &&
           std::ranges::equal(a.film.planes(), b.film.planes(), {}, &Plane::values, &Plane::values);
}

/// Whether a pixel's samples have a path each, however little work is asked for.
bool is_below_samples(const RunRequest& request, const WorkParameter& work, std::int64_t value) {
    const SampleCount& samples = request.method.facts().samples;
    return samples.of_a_pixel && samples.parameter == work.parameter &&
           value <= request.samples_per_pixel;
}

/// Says where a picture that has the work to fit its time does not.
Picture told_of_misfit(Picture picture, double seconds) {
    constexpr double most_misfit = 0.25;
    if (std::abs(picture.took.wall / seconds - 1) > most_misfit)
        picture.result.notes.push_back(
            fmt::format("the picture takes {:.3g} s in place of the {} s of --seconds",
                        picture.took.wall, shortest(seconds)));
    return picture;
}

/// The picture that takes the wanted time.
Picture picture_in_time(const RenderOptions& options) {
    const WorkParameter work = work_parameter(options);
    require_whole_work(options);
    TimeBudget budget(*options.seconds, work);
    std::optional<Picture> last;
    while (true) {
        const std::string chosen = fmt::format("{}={}", work.parameter, budget.work());
        RenderOptions trial = options;
        (options.work.empty() ? trial.method.params : trial.scene.sets).push_back(chosen);
        Picture picture = picture_of(trial);
        write_stderr(fmt::format("{}: {:.3g} s, {:.3g} CPU s of the {} s of --seconds\n", chosen,
                                 picture.took.wall, picture.took.cpu, shortest(*options.seconds)));
        if (last && are_same(last->result, picture.result) &&
            !is_below_samples(picture.request, work, budget.work())) {
            picture.result.notes.push_back(fmt::format(
                "{} makes no difference here, so that the picture does not take the {} s of "
                "--seconds{}",
                work.parameter, shortest(*options.seconds),
                options.work.empty() ? " (name a number of the scene by --work)" : ""));
            return picture;
        }
        if (!budget.goes_on_after(picture.took.wall))
            return told_of_misfit(std::move(picture), *options.seconds);
        last = std::move(picture);
    }
}

int render_picture(const RenderOptions& options) {
    end_soon_after_interrupts();
    check_outputs(options.outputs);
    if (!options.work.empty() && !options.seconds) throw InputError("--work: belongs to --seconds");
    auto [request, file, result, took] =
        options.seconds ? picture_in_time(options) : picture_of(options);

    require_finite(result.film, "the picture");
    write_stderr(told_counts(result.counters) + "\n");
    if (result.why_empty)
        write_stderr(fmt::format("the caustic is empty: {}\n", *result.why_empty));
    print_notes(result.notes);
    const double exposure = options.exposure.value_or(auto_exposure(result.film, ""));
    result.film.metadata = picture_metadata(request, file, result);
    result.film.metadata["tone_mapping"] = tone_mapping_rule;
    result.film.metadata["exposure"] = shortest(exposure);
    if (result.why_empty) result.film.metadata["why_empty"] = *result.why_empty;
    for (const std::string& output : options.outputs) {
        if (std::filesystem::path(output).extension() == ".exr")
            write_exr(result.film, output);
        else
            write_png(tone_map(result.film, "", exposure), output);
        write_stderr(
            fmt::format("{}: {}x{} pixels, {} samples a pixel, exposure {:.2f} stops, {:.1f} s\n",
                        output, result.film.width(), result.film.height(),
                        request.samples_per_pixel, exposure, took.wall));
    }
    if (options.seconds)
        write_stderr("the same picture again: " + command("render", request) + "\n");
    return 0;
}

}  // namespace

Verb add_render(CLI::App& app) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* const verb = app.add_subcommand("render", "Render one picture of a scene");
    options->scene.add_to(*verb);
    options->method.add_to(*verb);
    options->indirect.add_to(*verb);
    options->run.add_to(*verb);
    add_number(*verb, "--spp", options->spp, 1, 1'000'000,
               "Samples a pixel (default: the scene's)");
    add_number(*verb, "--exposure", options->exposure, -most_stops, most_stops,
               std::string("Exposure of a .png in stops: ") + tone_mapping_rule);
    add_number(*verb, "--seconds", options->seconds, 0.01, 1e7,
               "Chooses the method's work (photons, paths, mesh_resolution, ...) so that building "
               "and rendering take so many seconds on the clock; smaller trials come before");
    verb->add_option("--work", options->work,
                     "With --seconds: the whole number of the scene that takes them, in place of "
                     "the method's parameter, such as /water/resolution")
        ->type_name("/POINTER");
    add_repeatable(*verb, "-o,--output", options->outputs,
                   "Picture to write: .exr (float32, all layers) or .png (tone-mapped). Repeatable")
        ->required()
        ->type_name("FILE");
    verb->footer(
        "Example:\n  causticbench render pool.json --method photonmap --param photons=200000 "
        "--param nearest=80 -o pool.exr -o pool.png");
    return {verb, [options] { return render_picture(*options); }};
}

}  // namespace caustics::experiments

#include <fmt/format.h>

#include <memory>
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

RunResult run_shown(const Scene& scene, const RunRequest& request, const RunFlags& flags,
                    Stopwatch& stopwatch) {
    RunOptions options = flags.options(request.samples_per_pixel);
    const RunProgress progress(options, pass_count(request.method));
    return run(scene, request, options, stopwatch);
}

int render_picture(const RenderOptions& options) {
    end_soon_after_interrupts();
    check_outputs(options.outputs);
    SceneFile file = options.scene.load();
    const RunRequest request{options.scene.file,
                             options.scene.overrides(),
                             options.method.parse(),
                             options.run.seed,
                             samples_per_pixel(file.desc.sampling, options.spp),
                             options.indirect.parse()};
    require_files_apart(options.outputs, request, file.files);
    const Scene scene(std::move(file.desc));  // a copy of large meshes takes seconds
    Stopwatch stopwatch;
    RunResult result = run_shown(scene, request, options.run, stopwatch);

    require_finite(result.film, "the picture");
    write_stderr(told_counts(result.counters) + "\n");
    if (result.why_empty)
        write_stderr(fmt::format("the caustic is empty: {}\n", *result.why_empty));
    print_notes(result.notes);
    const double exposure = options.exposure.value_or(auto_exposure(result.film, ""));
    result.film.metadata = picture_metadata(request, file, result.report);
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
                        request.samples_per_pixel, exposure, stopwatch.total().wall));
    }
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

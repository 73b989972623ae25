#include <fmt/format.h>

#include <memory>
#include <optional>

#include "core/base/error.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/base/signals.h"
#include "experiments/cli/picture_in_time.h"
#include "experiments/cli/single_picture.h"
#include "experiments/cli/verbs.h"
#include "experiments/picture/metrics.h"
#include "experiments/picture/previews.h"

namespace caustics::experiments {

namespace {

/// Reaches every float from its smallest to its largest.
constexpr double most_stops = 150;

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

struct Rendered {
    SinglePicture picture;
    SceneFile file;  ///< without its shapes
};

Rendered rendered(const RenderOptions& options) {
    if (options.seconds) {
        PictureInTime in_time(options);
        SinglePicture picture = in_time.picture();
        return {std::move(picture), in_time.file()};
    }
    const LoadedScene scene(options);
    const Telling telling = options.has_few_light_paths ? Telling::of_few_paths : Telling::all;
    return {scene.picture_of(options, 1, telling), scene.file()};
}

int render_picture(const RenderOptions& options) {
    end_soon_after_interrupts();
    check_outputs(options.outputs);
    if (!options.work.empty() && !options.seconds) throw InputError("--work: belongs to --seconds");
    auto [picture, file] = rendered(options);
    const auto& request = picture.request;
    RunResult& result = picture.result;

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
                        request.samples_per_pixel, exposure, picture.took.wall));
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
               "CPU seconds of all threads that the whole command takes, from loading to writing: "
               "chooses the method's work (photons, paths, ...) by small trials, which are among "
               "them");
    verb->add_option("--work", options->work,
                     "With --seconds: the whole number of the scene that takes them, in place of "
                     "the method's parameter, such as /water/resolution")
        ->type_name("/POINTER");
    verb->add_flag(
        "--few-light-paths", options->has_few_light_paths,
        "Compare the picture's light with 50,000 light paths, even where 400,000 would tell "
        "more, as --seconds does");
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

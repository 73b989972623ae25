#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/base/step_progress.h"
#include "experiments/cli/verbs.h"
#include "experiments/run/cli_options.h"
#include "experiments/verify/verify_gallery.h"
#include "experiments/verify/verify_scene.h"

namespace caustics::experiments {

namespace {

struct VerifyOptions {
    SceneOptions scene;
    std::vector<std::string> methods;
    std::vector<std::string> params;
    bool gallery = false;
    bool allow_converging = false;
    int spp = 0;
    double seconds = 60;
    RunFlags run;
};

bool is_wanted(const std::vector<std::string>& methods, const std::string& name) {
    return methods.empty() || std::ranges::find(methods, name) != methods.end();
}

std::size_t series_of(const std::vector<GalleryScene>& scenes,
                      const std::vector<std::string>& methods) {
    std::size_t count = 0;
    for (const GalleryScene& scene : scenes)
        for (const Series& series : scene.series) count += is_wanted(methods, series.method);
    return count;
}

int verify_gallery(const VerifyOptions& options, const RunOptions& run) {
    const std::vector<GalleryScene> scenes = gallery();
    for (const std::string& name : options.methods)
        if (series_of(scenes, {name}) == 0)
            throw InputError(
                fmt::format("--method {}: the gallery has no known answer for it", name));
    StepProgress progress(series_of(scenes, options.methods));
    std::vector<SeriesOutcome> outcomes;
    bool holds = true;
    for (const GalleryScene& scene : scenes)
        for (const Series& series : scene.series) {
            if (!is_wanted(options.methods, series.method)) continue;
            progress.begin(fmt::format("{} {}", scene.name, series.method));
            RunOptions with_progress = run;
            with_progress.progress = [&progress](double share) { progress.share(share); };
            outcomes.push_back(run_series(scene, series, with_progress));
            const SeriesOutcome& last = outcomes.back();
            holds = holds && last.holds();
            progress.end(!last.refusal.empty()
                             ? "refused"
                             : fmt::format("error {:.2g}{}", last.errors.back(),
                                           last.holds() ? "" : ": DOES NOT HOLD"));
        }
    write_stdout(gallery_table(scenes, outcomes));
    return holds ? 0 : 1;
}

int verify(const VerifyOptions& options) {
    for (const std::string& name : options.methods)
        if (!options.gallery || std::ranges::find(indirect_names(), name) == indirect_names().end())
            parse_method(name, parameters_node({}));
    if (options.gallery == !options.scene.file.empty())
        throw InputError("verify: give either a scene or --gallery");
    if (!options.params.empty() && (options.gallery || options.methods.size() != 1))
        throw InputError("--param: belongs to one --method, on a scene");
    if (options.gallery && !options.scene.sets.empty())
        throw InputError("--set: changes a scene, and --gallery takes its own as they are");
    if (options.gallery && (options.spp > 0 || options.allow_converging))
        throw InputError("--spp, --allow-converging: belong to a scene, not to --gallery");
    if (options.gallery) return verify_gallery(options, options.run.options(1));
    SceneFile file = options.scene.load();
    VerifySettings settings;
    for (const std::string& name : options.methods)
        settings.methods.emplace_back(name, options.params);
    settings.run = options.run.options(samples_per_pixel(file.desc.sampling, options.spp));
    settings.seconds = options.seconds;
    const SceneReport report = verify_scene(std::move(file), settings);
    write_stdout(report.text());
    return report.holds(options.allow_converging) ? 0 : 1;
}

}  // namespace

Verb add_verify(CLI::App& app) {
    auto options = std::make_shared<VerifyOptions>();
    CLI::App* const verb =
        app.add_subcommand("verify", "Check methods: on a scene, or on those with known answers");
    options->scene.add_to(*verb);
    verb->get_option("SCENE")->required(false);
    add_repeatable(*verb, "--method", options->methods, "Only this method. Repeatable")
        ->type_name("NAME");
    add_repeatable(*verb, "--param", options->params,
                   "Parameter of the method, where one is named (default: the method's defaults, "
                   "as `render` has them). Repeatable")
        ->type_name("KEY=VALUE");
    add_number(*verb, "--spp", options->spp, 1, 1'000'000,
               "Samples a pixel (default: the scene's)");
    add_number(*verb, "--seconds", options->seconds, 0.0, 1e7,
               "Seconds that the pictures of one method at one setting may take, beyond the first "
               "twelve, until their error is small enough (default 60)");
    verb->add_flag("--allow-converging", options->allow_converging,
                   "Exit code 0 also where a method converges");
    verb->add_flag("--gallery", options->gallery,
                   "Scenes whose answers are formulas: error of each method at growing effort");
    options->run.add_to(*verb);
    verb->footer(
        "SCENE: an account of the light (what leaves the lights is absorbed, escapes or arrives), "
        "the\n"
        "same picture with any number of threads, and each method, at the given settings, against "
        "an\n"
        "unbiased reference, in the whole picture and in 6 x 4 cells of it. Four answers:\n"
        "  holds      the whole is within 2 % and within five standard errors of the difference, "
        "each\n"
        "             cell within 9.8 % (sqrt(24) times 2 %) of its light or of the picture's "
        "mean\n"
        "  converges  not so, but 4 and 16 times the work (photons, mesh_resolution^2, ...) make "
        "the\n"
        "             difference smaller: |difference| ~ work^-order, order at least 1/4, and "
        "what\n"
        "             remains by extrapolation is no more than 2 % and five standard errors\n"
        "  fails      the difference does not shrink so\n"
        "  unsure     the standard error of the difference is above 0.4 % (in a cell 2.0 %)\n"
        "Where there is no caustic, the report says why.\n"
        "Exit code 0 if all holds, 1 if not, 3 if a named method cannot serve the scene.\n"
        "Example:\n  causticbench verify experiments/scenes/pool.json");
    return {verb, [options] { return verify(*options); }};
}

}  // namespace caustics::experiments

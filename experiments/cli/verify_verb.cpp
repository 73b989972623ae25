#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
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
    bool gallery = false;
    MachineFlags machine;
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
    if (options.gallery && !options.scene.sets.empty())
        throw InputError("--set: changes a scene, and --gallery takes its own as they are");
    RunOptions run;
    run.threads = options.machine.threads > 0 ? options.machine.threads : available_threads();
    run.isa = options.machine.isa;
    if (options.gallery) return verify_gallery(options, run);
    const SceneReport report = verify_scene(options.scene.load(), options.methods, run);
    write_stdout(report.text());
    return report.holds() ? 0 : 1;
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
    verb->add_flag("--gallery", options->gallery,
                   "Scenes whose answers are formulas: error of each method at growing effort");
    options->machine.add_to(*verb, "all");
    verb->footer(
        "SCENE: an account of the light (what leaves the lights is absorbed, escapes or arrives), "
        "the\n"
        "same picture with any number of threads, each method against the reference in cells of "
        "the\n"
        "picture, and why there is no caustic if there is none.\n"
        "Exit code 0 if all holds, 1 if not, 3 if a named method cannot serve the scene.\n"
        "Example:\n  causticbench verify experiments/scenes/pool.json");
    return {verb, [options] { return verify(*options); }};
}

}  // namespace caustics::experiments

#include "experiments/cli/single_picture.h"

#include "core/base/error.h"
#include "experiments/run/cost_forecast.h"
#include "experiments/run/run_progress.h"
#include "experiments/run/written_files.h"

namespace caustics::experiments {

namespace {

RunRequest picture_request(const RenderOptions& options, const SceneFile& file) {
    return {options.scene.file,
            options.scene.overrides(),
            options.method.parse(),
            options.run.seed,
            samples_per_pixel(file.desc.sampling, options.spp),
            options.indirect.parse()};
}

SceneFile loaded(const RenderOptions& options) {
    SceneFile file = options.scene.load();
    require_files_apart(options.outputs, picture_request(options, file), file.files);
    return file;
}

/// Phases of a picture that takes long, by trials that then take a small part of it; else nothing. What a trial cannot tell
/// is left to the picture.
std::map<std::string, double> plan_of(const Scene& scene, const RunRequest& request, int threads) {
    constexpr double long_samples = 1e7;
    constexpr double much_work = 20;
    const Camera& camera = scene.camera();
    const double samples = double{1} * camera.width * camera.height * request.samples_per_pixel;
    if (request.indirect ||
        (samples < long_samples && work_over_default(request.method) < much_work))
        return {};
    try {
        auto phases = CostForecast(scene, request.samples_per_pixel).phases_of(request.method);
        for (auto& [phase, seconds] : phases) seconds /= threads;
        return phases;
    } catch (const InputError&) {
    } catch (const UnsupportedScene&) {}
    return {};
}

}  // namespace

// A copy of large meshes takes seconds.
LoadedScene::LoadedScene(const RenderOptions& options)
    : file_(loaded(options)), scene_(take_shapes(file_)) {}

SinglePicture LoadedScene::picture_of(const RenderOptions& options, int pixel_step, Telling telling,
                                      const std::function<void()>& check) const {
    RunRequest request = picture_request(options, file_);
    request.pixel_step = pixel_step;
    request.telling = telling;
    Stopwatch stopwatch;
    RunOptions run_options = options.run.options(request.samples_per_pixel);
    const auto plan = [&] { return plan_of(scene_, request, run_options.threads); };
    const RunProgress progress(run_options, pass_count(request.method),
                               check ? std::function<std::map<std::string, double>()>{} : plan);
    if (check)
        run_options.progress = [&check, show = run_options.progress](double share) {
            check();
            show(share);
        };
    const double before = cpu_seconds_used();
    RunResult result = run(scene_, request, run_options, stopwatch);
    const double render = stopwatch.of_stage("render").cpu;
    const double planned = stopwatch.of("precompute/plan").cpu;
    const Seconds took = stopwatch.worked();
    const double told = cpu_seconds_used() - before - took.cpu;
    return {std::move(request), std::move(result), took, render, planned, told};
}

}  // namespace caustics::experiments

#include "experiments/cli/single_picture.h"

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

}  // namespace

// A copy of large meshes takes seconds.
LoadedScene::LoadedScene(const RenderOptions& options)
    : file_(loaded(options)), scene_(take_shapes(file_)) {}

SinglePicture LoadedScene::picture_of(const RenderOptions& options, int pixel_step,
                                      const std::function<void()>& check) const {
    RunRequest request = picture_request(options, file_);
    request.pixel_step = pixel_step;
    request.is_trial = pixel_step > 1;
    Stopwatch stopwatch;
    RunOptions run_options = options.run.options(request.samples_per_pixel);
    const RunProgress progress(run_options, pass_count(request.method));
    if (check)
        run_options.progress = [&check, show = run_options.progress](double share) {
            check();
            show(share);
        };
    const double before = cpu_seconds_used();
    RunResult result = run(scene_, request, run_options, stopwatch);
    double render = 0;
    for (const auto& [phase, seconds] : stopwatch.phases())
        if (phase.starts_with("render")) render += seconds.cpu;
    const Seconds took = stopwatch.worked();
    const double told = cpu_seconds_used() - before - took.cpu;
    return {std::move(request), std::move(result), took, render, told};
}

}  // namespace caustics::experiments

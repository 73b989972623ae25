#include "experiments/verify/picture_series.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/render/renderer.h"
#include "experiments/base/stopwatch.h"
#include "experiments/picture/metrics.h"

namespace caustics::experiments {

namespace {

/// The standard error of fewer pictures says too little to plan by.
constexpr std::size_t planned_from = 4;

Film layers_that_count(const Film& film) {
    Film kept(film.width(), film.height());
    for (const Plane& plane : film.planes())
        if (plane.channel.starts_with("caustic.") || plane.channel.starts_with("unreached."))
            kept.plane(plane.channel) = plane.values;
    return kept;
}

/// The share of a series that is done, by the number of pictures that it is expected to take.
double share_done(std::size_t count, const SeriesLength& length, double excess, double seconds) {
    const auto n = static_cast<double>(count), least = static_cast<double>(length.least);
    const double wanted = std::max(least, n * excess * excess);
    const double in_time = std::max(least, seconds > 0 ? n * length.seconds / seconds : wanted);
    return n / std::min(wanted, in_time);
}

}  // namespace

Film picture_of(const Scene& scene, const Method& method, const RunOptions& options,
                const std::function<void(const BuildReport&)>& built) {
    const auto build_pass = [&](int pass) {
        auto estimator = build(scene, method, options, pass);
        if (pass == 0 && built) built(estimator->build_report());
        return estimator;
    };
    return render(scene, {pass_count(method), build_pass}, options).film;
}

PictureSeries::PictureSeries(const Scene& scene, Method method, RunOptions options)
    : scene_(scene), method_(std::move(method)), options_(std::move(options)) {}

void PictureSeries::fill(const SeriesLength& length, const std::function<double()>& excess,
                         StepProgress& progress) {
    const Stopwatch watch;
    double shown = 0;
    while (true) {
        const double seconds = watch.total().wall;
        const double too_large = films_.size() < planned_from ? 1 : excess();
        if (films_.size() >= length.least && (too_large <= 1 || seconds >= length.seconds)) return;
        if (films_.size() >= planned_from)
            shown = std::max(shown, share_done(films_.size(), length, too_large, seconds));
        add(progress, shown);
    }
}

void PictureSeries::add(StepProgress& progress, double share) {
    RunOptions options = options_;
    options.seed += films_.size();
    options.progress = [&](double) { progress.share(share); };
    const Film film = picture_of(scene_, method_, options);
    require_finite(film, "caustic", method_.name);
    films_.push_back(layers_that_count(film));
}

}  // namespace caustics::experiments

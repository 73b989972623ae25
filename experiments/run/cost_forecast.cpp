#include "experiments/run/cost_forecast.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "experiments/base/environment.h"
#include "experiments/run/render_and_score.h"

namespace caustics::experiments {

namespace {

// The pixels of a trial: a share of the picture's, within bounds.
constexpr double pixel_share = 1.0 / 40;
constexpr double fewest_pixels = 2000;
constexpr double most_pixels = 10'000;
// The first trial's share of the work, and one that tells enough.
constexpr double first_share = 1.0 / 256;
constexpr double enough = 1.0 / 8;
// The first trial's polygons, where there are few.
constexpr double fewest_polygons = 4;
// From trial to trial; the least where more would be a long one.
constexpr double least_growth = 8;
constexpr double least_before_long = 2;
constexpr double most_growth = 32;
// Seconds that the work takes in the last trial, at least, and as a share of what the first trial took.
constexpr double told_seconds = 0.15;
constexpr double told_part = 0.5;
// After a long trial there is no other, and one that is too long is given up: seconds, and of what a picture without a caustic
// takes to be told of.
constexpr double long_seconds = 1.5;
constexpr double long_part = 3;
constexpr double too_long = 2;  ///< of a long one

/// A trial is given up.
struct TooLong : std::exception {};

/// The line through the values at two shares of the work, at all of it. More work is never cheaper.
double on_line(double before, double share_before, double last, double share) {
    const double slope = std::max(0.0, last - before) / (share - share_before);
    return last + slope * (1 - share);
}

/// The same for what may grow with a power of the work up to 1, or not at all.
double on_power(double before, double share_before, double last, double share) {
    if (before <= 0 || last <= before) return last;
    const double power = std::log(last / before) / std::log(share / share_before);
    return last * std::pow(1 / share, std::min(power, 1.0));
}

/// The share of a method's work that costs next to nothing (WorkParameter); 1 where it is not known.
double share_of_least_work(const Method& method) {
    const WorkParameter work = method.configured->work();
    if (work.power != 1) return 1;
    const nlohmann::json values = describe(method);
    for (const std::string& name : {work.parameter, work.instead})
        if (const auto value = values.find(name); value != values.end() && value->is_number())
            return static_cast<double>(work.first) / value->get<double>();
    return 1;
}

}  // namespace

double work_over_default(const Method& method) {
    return share_of_least_work(parse_method(method.name, parameters_node({}))) /
           share_of_least_work(method);
}

CostForecast::CostForecast(const Scene& scene, int samples_per_pixel)
    : scene_(scene), samples_per_pixel_(samples_per_pixel) {
    const double pixels = static_cast<double>(scene.camera().width) * scene.camera().height;
    pixel_step_ = static_cast<int>(
        std::max(1.0, pixels / std::clamp(pixel_share * pixels, fewest_pixels, most_pixels)));
    // The film takes its time, however few pixels are rendered.
    const Method none = parse_method("none", parameters_node({}));
    const double told = trial(none, 1, std::numeric_limits<int>::max()).took;
    long_ = std::max(long_seconds, long_part * told);
    film_ = trial(none, 1, std::numeric_limits<int>::max()).caustic;
    eye_ = trial(none, 1, pixel_step_).caustic;
}

CostForecast::Trial CostForecast::trial(const Method& method, double share, int pixel_step) const {
    Trial trial;
    RunRequest request;
    request.method = method;
    request.samples_per_pixel = samples_per_pixel_;
    request.pixel_step = pixel_step;
    request.telling = Telling::of_few_paths;
    std::tie(request.method.configured, trial.share) = method.configured->with_share_of_work(share);
    RunOptions options;
    options.adaptive = false;

    reset_peak_resident_bytes();
    const auto resident = static_cast<double>(resident_bytes());
    const double before = cpu_seconds_used();
    Stopwatch stopwatch;
    options.progress = [&](double) {
        if (cpu_seconds_used() - before > too_long * long_) throw TooLong();
    };
    std::size_t written = 0;
    try {
        const RunResult result = run(scene_, request, options, stopwatch);
        written = result.film.planes().size() * result.film.pixel_count() * sizeof(float);
    } catch (const TooLong&) {
        trial.is_whole = false;
    }
    trial.took = cpu_seconds_used() - before;
    // A picture that is written is in memory twice.
    trial.bytes =
        static_cast<double>(peak_resident_bytes()) - resident + static_cast<double>(written);
    const double render = stopwatch.of_stage("render").cpu;
    for (const auto& [phase, seconds] : stopwatch.phases())
        if (phase.starts_with("precompute"))
            trial.phases[phase.substr(phase.find('/') + 1)] += seconds.cpu;
    trial.build = trial.took - render;
    trial.caustic = std::max(0.0, render - film_ - eye_);
    return trial;
}

CostForecast::Trials CostForecast::trials(const Method& method, std::uint64_t polygons) const {
    const double few = polygons > 0 ? fewest_polygons / static_cast<double>(polygons) : 0;
    const double least = std::min(first_share, share_of_least_work(method));
    const Trial first = trial(method, std::clamp(few, least, 1.0), pixel_step_);
    Trials trials{first, first, first.share >= enough};
    const double told = std::max(told_seconds, told_part * first.took);
    double growth = std::clamp(1 / first.took, least_growth, most_growth);
    while (!trials.are_enough && trials.last.is_whole && trials.last.took < long_) {
        trials.before = trials.last;
        trials.last = trial(method, std::min(growth * trials.last.share, 1.0), pixel_step_);
        const double more = trials.last.took - first.took;
        trials.are_enough = trials.last.share >= enough || more >= told;
        growth = std::clamp(told / std::max(more, 1e-9), least_growth, most_growth);
        if (growth * more > long_ - first.took)
            growth = std::max((long_ - first.took) / more, least_before_long);
    }
    return trials;
}

double CostForecast::whole(const Trials& trials, const std::function<double(const Trial&)>& value,
                           double (*curve)(double, double, double, double)) {
    const auto& [before, last, _] = trials;
    if (before.share == last.share) return value(last);
    return curve(value(before), before.share, value(last), last.share);
}

double CostForecast::caustic_of(const Method& method, const Trials& trials) const {
    // Light paths connect to the camera by themselves, however many pixels are asked for.
    if (method.facts().samples.is_of_picture()) return whole(trials, &Trial::caustic, on_line);
    return pixel_step_ * whole(trials, &Trial::caustic, on_power);
}

PictureCost CostForecast::of(const Method& method, std::uint64_t polygons) const {
    const Trials all = trials(method, polygons);
    if (!all.last.is_whole) return {all.last.took, all.last.bytes, true};
    return {
        film_ + pixel_step_ * eye_ + whole(all, &Trial::build, on_line) + caustic_of(method, all),
        whole(all, &Trial::bytes, on_line), !all.are_enough};
}

std::map<std::string, double> CostForecast::phases_of(const Method& method) const {
    const Trials all = trials(method, 0);
    if (!all.are_enough || !all.last.is_whole) return {};
    std::map<std::string, double> phases;
    for (const auto& [phase, seconds] : all.last.phases)
        phases[phase] = whole(
            all,
            [&name = phase](const Trial& trial) {
                const auto own = trial.phases.find(name);
                return own == trial.phases.end() ? 0 : own->second;
            },
            on_line);
    phases["render"] = film_ + pixel_step_ * eye_ + caustic_of(method, all);
    return phases;
}

}  // namespace caustics::experiments

#include "experiments/cli/picture_in_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

// Writing of a pixel [CPU s].
constexpr double writing_a_pixel = 1.2e-6;
// So many pixels tell the time of all.
constexpr double few_pixels = 2000;
constexpr double most_pixel_step = 20;

std::string given_parameter(const RenderOptions& options, const WorkParameter& work) {
    for (const std::string& param : options.method.params)
        if (param.starts_with(work.parameter + "=")) return param;
    return "";
}

/// The parameter whose value --seconds chooses.
WorkParameter work_parameter(const RenderOptions& options) {
    constexpr std::int64_t most_of_scene = 4096;
    const Method method = options.method.parse();
    if (!options.work.empty())
        return {.parameter = options.work, .power = 2, .first = 8, .most = most_of_scene};
    const WorkParameter work = method.configured ? method.configured->work() : method.facts().work;
    if (work.parameter.empty())
        throw InputError(fmt::format(
            "--seconds: {} has no parameter that could take them (take another method, or name a "
            "number of the scene by --work)",
            options.method.name));
    if (const std::string param = given_parameter(options, work); !param.empty())
        throw InputError(
            fmt::format("--seconds chooses {}: leave --param {} out", work.parameter, param));
    return work;
}

bool is_whole(const nlohmann::json& value) {
    if (value.is_number_integer()) return true;
    return value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>();
}

/// Refuses a value of the scene that whole numbers do not stand for; one that is not there may be set.
void require_whole_work(const RenderOptions& options, const SceneFile& file) {
    if (options.work.empty() || options.work[0] != '/') return;
    const auto scene = nlohmann::json::parse(file.canonical);
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

/// Answers whether more work made no difference, neither in the picture nor in the counts.
bool are_same(const RunResult& a, const RunResult& b) {
    return a.counters == b.counters &&
           std::ranges::equal(a.film.planes(), b.film.planes(), {}, &Plane::values, &Plane::values);
}

TimeBudget::Work work_kind(const RenderOptions& options, const WorkParameter& work) {
    const SampleCount& samples = options.method.parse().facts().samples;
    return samples.parameter == work.parameter && samples.is_of_picture()
               ? TimeBudget::Work::of_picture
               : TimeBudget::Work::of_pixels;
}

/// The parameter that takes the time where the usual one makes no difference; none has an empty name.
WorkParameter other_work(const RenderOptions& options, const WorkParameter& work,
                         const Scene& scene) {
    const Method method = options.method.parse();
    const WorkParameter& other = method.facts().work;
    const bool has_exact_caster = std::ranges::any_of(scene.casters(), [&](std::uint32_t caster) {
        const Primitive primitive = scene.shapes()[caster].primitive;
        return std::ranges::find(exact_primitives, primitive) != exact_primitives.end();
    });
    if (!options.work.empty() || other.parameter == work.parameter || !has_exact_caster ||
        !given_parameter(options, other).empty())
        return {};
    return other;
}

/// A number of seconds that is no less, with two digits.
std::string rounded_up(double seconds) {
    const double place = std::floor(std::log10(seconds)) - 1;
    const double digit = std::pow(10.0, place);
    return fmt::format("{:.{}f}", std::ceil(seconds / digit) * digit,
                       std::max(0, -static_cast<int>(place)));
}

}  // namespace

PictureInTime::PictureInTime(const RenderOptions& options)
    : options_(options), seconds_(*options.seconds), work_(work_parameter(options)) {
    scene_.emplace(options);
    require_whole_work(options, file());
    loading_ = cpu_seconds_used();
    const Scene& scene = scene_->scene();
    const Method method = options.method.parse();
    const auto pixels = static_cast<double>(scene.camera().width) * scene.camera().height;
    writing_ = writing_a_pixel * pixels * static_cast<double>(options.outputs.size());
    ending_ = writing_;
    // Adaptive samples go where the first ones scatter.
    if (scene.sampling().max_sample_count == 0)
        pixel_step_ = static_cast<int>(std::clamp(pixels / few_pixels, 1.0, most_pixel_step));
    // Less would be the same picture.
    if (method.facts().samples.of_a_pixel && options.work.empty())
        work_.first = samples_per_pixel(scene.sampling(), options.spp);
}

double PictureInTime::left() const { return seconds_ - cpu_seconds_used() - ending_; }

std::string PictureInTime::least_text(const std::string& least) const {
    return fmt::format(
        "--seconds {}: the least that this picture takes is {} CPU seconds, {:.2g} of them for "
        "loading",
        shortest(seconds_), least, loading_);
}

bool PictureInTime::has_time_for(double more) const {
    // Half of the tolerance stays free, for the picture may take longer than foretold.
    return cpu_seconds_used() + ending_ + more <= (1 + TimeBudget::tolerance / 2) * seconds_;
}

void PictureInTime::refuse(double more) const {
    const std::string least = rounded_up(cpu_seconds_used() + ending_ + more);
    throw InputError(
        fmt::format("{} (give --seconds {} or more)", least_text("about " + least), least));
}

SinglePicture PictureInTime::made(const WorkParameter& work, const TimeBudget::Plan& plan) {
    // A trial may take so long to tell how many seconds would be enough.
    const double most = 2 * seconds_ + 5;
    const double before = cpu_seconds_used();
    const std::string chosen = fmt::format("{}={}", work.parameter, plan.work);
    RenderOptions trial = options_;
    (options_.work.empty() ? trial.method.params : trial.scene.sets).push_back(chosen);
    if (!options_.work.empty()) scene_.emplace(trial);
    // Comparing its light with light paths takes as long for each picture: the first trial tells how long.
    const Telling telling =
        may_refuse_ || plan.is_last || pixel_step_ == 1 ? Telling::of_few_paths : Telling::nothing;
    SinglePicture picture = scene_->picture_of(trial, plan.is_last ? 1 : pixel_step_, telling, [&] {
        if (may_refuse_ && cpu_seconds_used() > most)
            throw InputError(least_text("more than " + shortest(most)));
    });
    const double all = cpu_seconds_used() - before - picture.told_cpu;
    cost_ = {.build = all - picture.render_cpu - picture.plan_cpu,
             .render = picture.render_cpu,
             .fixed = picture.plan_cpu};
    if (may_refuse_) ending_ += picture.told_cpu;
    may_refuse_ = false;
    return picture;
}

void PictureInTime::tell(const WorkParameter& work, const TimeBudget::Plan& plan) const {
    const std::string pixels =
        plan.is_last || pixel_step_ == 1 ? "" : fmt::format(", 1 of {} pixels", pixel_step_);
    write_stderr(fmt::format(
        "{}={}{}: {:.3g} CPU s, with which {:.3g} of the {} CPU s of --seconds are used\n",
        work.parameter, plan.work, pixels, cost_.fixed + cost_.build + cost_.render,
        cpu_seconds_used(), shortest(seconds_)));
}

PictureInTime::Found PictureInTime::search(const WorkParameter& work) {
    TimeBudget budget(work, work_kind(options_, work), pixel_step_);
    const TimeBudget::Plan least{budget.plan().work, true};
    std::optional<SinglePicture> last;
    while (!budget.plan().is_last) {
        const TimeBudget::Plan plan = budget.plan();
        SinglePicture trial = made(work, plan);
        const bool is_same = last && are_same(last->result, trial.result);
        if (!is_same) budget.take(cost_, left());
        if (!last && !has_time_for(budget.least())) {
            // A picture of all pixels needs not be made again.
            if (pixel_step_ == 1 && has_time_for(0))
                return {Ending::filled, least, std::move(trial)};
            return {Ending::too_much, least, {}, pixel_step_ == 1 ? 0 : budget.least()};
        }
        tell(work, plan);
        if (is_same) return {Ending::same, least, {}};
        last = std::move(trial);
    }
    return {Ending::filled, budget.plan(), {}};
}

SinglePicture PictureInTime::told_of_misfit(SinglePicture picture) const {
    const double used = cpu_seconds_used() + writing_;
    if (std::abs(used / seconds_ - 1) > TimeBudget::tolerance)
        picture.result.notes.push_back(
            fmt::format("the command takes {:.3g} CPU s in place of the {} s of --seconds", used,
                        shortest(seconds_)));
    return picture;
}

SinglePicture PictureInTime::picture() {
    WorkParameter work = work_;
    Found found = search(work);
    if (found.ending == Ending::too_much) refuse(found.seconds);
    if (found.ending == Ending::same) {
        const WorkParameter other = other_work(options_, work, scene_->scene());
        if (!other.parameter.empty()) {
            Found with_other = search(other);
            if (with_other.ending != Ending::too_much) {
                work = other;
                found = std::move(with_other);
            }
        }
    }
    const bool is_same = found.ending == Ending::same;
    SinglePicture picture = found.picture ? std::move(*found.picture) : made(work, found.plan);
    tell(work, found.plan);
    if (!is_same) return told_of_misfit(std::move(picture));
    picture.result.notes.push_back(
        fmt::format("{} makes no difference here, so that the picture does not take the {} s of "
                    "--seconds{}",
                    work.parameter, shortest(seconds_),
                    options_.work.empty() ? " (name a number of the scene by --work)" : ""));
    return picture;
}

}  // namespace caustics::experiments

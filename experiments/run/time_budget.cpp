#include "experiments/run/time_budget.h"

#include <algorithm>
#include <cmath>

namespace caustics::experiments {

namespace {

// Shares of what is left that trials are to take: the second, and those that follow, beyond what the least work takes.
constexpr double share_of_second = 0.04;
constexpr double share_of_later = 0.2;
// How far beyond the trials is foretold: near ones surely, others where the last two differ by a good part of what is left.
constexpr double most_growth = 32;
constexpr double sure_growth = 3;
constexpr double good_part = 0.12;
constexpr double sure_part = 0.13;  // a little more than that
constexpr double first_growth = 8;
constexpr double least_growth = 2;
// Methods may do otherwise with very little work: two trials tell nothing yet.
constexpr std::size_t least_trials = 3;
// Times that differ by less of themselves do so by chance.
constexpr double chance = 0.05;
constexpr double least_seconds = 1e-6;
// Power of the work that rendering is taken to grow with after one trial: 1/4 to 1/3 was measured with pencils, and hardly
// any with photons.
constexpr double render_power = 1.0 / 3;
constexpr double times_precision = 1e-3;

}  // namespace

TimeBudget::TimeBudget(const WorkParameter& parameter, Work kind, int pixel_step)
    : parameter_(parameter),
      kind_(kind),
      pixel_step_(pixel_step),
      first_size_(std::pow(static_cast<double>(parameter.first), parameter.power)) {
    plan_of(first_size_, false);
}

void TimeBudget::plan_of(double size, bool is_last) {
    // Powers and roots of whole numbers may end just below them.
    const double root = std::pow(size, 1.0 / parameter_.power) * (1 + 1e-12);
    plan_ = {static_cast<std::int64_t>(std::clamp(root, static_cast<double>(parameter_.first),
                                                  static_cast<double>(parameter_.most))),
             is_last};
}

double TimeBudget::size_that_takes(double seconds, double Trial::* cost) const {
    const Trial& last = trials_.back();
    const Trial& before = trials_[trials_.size() - 2];
    const double step = last.size - before.size;
    const double slope =
        std::max((last.*cost - before.*cost) / step, chance * last.*cost / std::abs(step));
    return std::clamp(last.size + (seconds - last.*cost) / slope, first_size_,
                      most_growth * last.size);
}

double TimeBudget::size_of_next_trial(double left) const {
    const Trial& last = trials_.back();
    // Room is left for the least picture. Whatever its constant is, a trial takes no more than in proportion to its work.
    const double spare = std::max((left - least()) / 2, 0.0);
    const double sure = last.size * spare / last.seconds;
    if (trials_.size() == 1) {
        // The first costs next to nothing beyond its constant (WorkParameter).
        const double next = std::max(sure, last.seconds < spare ? first_growth * last.size : 0.0);
        return std::min(next, last.size * std::clamp(share_of_second * left / last.seconds,
                                                     first_growth, most_growth));
    }
    const double seconds =
        std::max(trials_.front().seconds + share_of_later * left, last.seconds + sure_part * left);
    const double size = size_that_takes(std::min(seconds, spare), &Trial::seconds);
    return std::max(size, std::min(sure, least_growth * last.size));
}

bool TimeBudget::is_enough(double left) const {
    if (trials_.size() < least_trials) return false;
    const Trial& last = trials_.back();
    return size_that_takes(left, &Trial::whole) <= sure_growth * last.size ||
           last.seconds - trials_[trials_.size() - 2].seconds >= good_part * left;
}

double TimeBudget::size_by_one_trial(double left) const {
    const Trial& trial = trials_.front();
    const double build = trial.whole - trial.fixed - trial.render;
    // Points are answered in a time that grows slower than the work; light paths are not.
    const double power = kind_ == Work::of_picture ? 1 : render_power;
    const auto seconds = [&](double times) {
        return trial.fixed + times * build + std::pow(times, power) * trial.render;
    };
    double least = 1;
    double most = first_growth;
    while (most - least > times_precision) {
        const double middle = (least + most) / 2;
        (seconds(middle) > left ? most : least) = middle;
    }
    return least * trial.size;
}

double TimeBudget::size_of_picture(double left) const {
    const Trial& last = trials_.back();
    if (trials_.size() == 1) return size_by_one_trial(left);
    const double size = size_that_takes(left, &Trial::whole);
    return is_enough(left) ? size : std::min(size, first_growth * last.size);
}

void TimeBudget::take(const Cost& cost, double left) {
    const double build = std::max(cost.build, 0.0);
    const double render = std::max(cost.render, least_seconds);
    if (trials_.empty()) first_render_ = render;
    const double grows = kind_ == Work::of_picture ? first_render_ : render;
    const double seconds = cost.fixed + build + render;
    const double more = (pixel_step_ - 1) * grows;
    trials_.push_back({std::pow(static_cast<double>(plan_.work), parameter_.power), seconds,
                       seconds + more, cost.fixed, render + more});
    if (left <= least()) return plan_of(first_size_, true);
    if (!is_enough(left)) {
        const std::int64_t done = plan_.work;
        const double next = size_of_next_trial(left);
        plan_of(next, false);
        if (next >= least_growth * trials_.back().size && plan_.work != done) return;
    }
    plan_of(size_of_picture(left), true);
}

}  // namespace caustics::experiments

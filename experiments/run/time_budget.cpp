#include "experiments/run/time_budget.h"

#include <algorithm>
#include <cmath>

namespace caustics::experiments {

namespace {

// What all trials may take before the last one, in wanted times.
constexpr double most_spent = 3;
// What lies so far beyond the trials is not foretold.
constexpr double most_growth = 32;
constexpr double first_growth = 8;
// Times that differ by less of themselves do so by chance.
constexpr double chance = 0.05;

}  // namespace

TimeBudget::TimeBudget(double seconds, const WorkParameter& work)
    : wanted_(seconds), parameter_(work), work_(work.first) {}

double TimeBudget::next_size(const Trial& trial) const {
    if (!last_) return trial.size * std::min(wanted_ / trial.seconds, first_growth);
    const double step = trial.size - last_->size;
    const double slope =
        std::max((trial.seconds - last_->seconds) / step, chance * trial.seconds / std::abs(step));
    return std::min(trial.size + (wanted_ - trial.seconds) / slope, most_growth * trial.size);
}

bool TimeBudget::goes_on_after(double seconds) {
    const Trial trial{std::pow(static_cast<double>(work_), parameter_.power),
                      std::max(seconds, 1e-6)};
    if (std::abs(seconds / wanted_ - 1) <= tolerance) return false;
    spent_ += trial.seconds;
    if (spent_ > most_spent * wanted_) return false;
    const double root = std::pow(std::max(next_size(trial), 0.0), 1.0 / parameter_.power);
    const auto next = static_cast<std::int64_t>(std::clamp(
        root, static_cast<double>(parameter_.first), static_cast<double>(parameter_.most)));
    if (next == work_) return false;
    last_ = trial;
    work_ = next;
    return true;
}

}  // namespace caustics::experiments

#include "experiments/base/step_progress.h"

#include <algorithm>

#include "core/base/interrupt.h"

namespace caustics::experiments {

void StepProgress::begin(const std::string& what, std::optional<double> expected) {
    what_ = what;
    expected_ = expected;
    begun_ = std::chrono::steady_clock::now();
    share(0);
}

void StepProgress::expect_later(Eta later) { later_ = later; }

void StepProgress::share(double done) {
    throw_if_interrupted();
    if (!progress_.is_due()) return;
    const std::unique_lock lock(showing_, std::try_to_lock);
    if (lock.owns_lock() && progress_.is_due()) progress_.show(what_, done, remaining(done));
}

double StepProgress::end(const std::string& result) {
    const double seconds = seconds_since(begun_);
    ++finished_;
    progress_.end(what_ + ": " + result, true, later_ ? later_ : remaining(0));
    return seconds;
}

std::optional<Eta> StepProgress::remaining(double share) const {
    if (later_) {
        const std::optional<Eta> now = remaining_of_step(share);
        return Eta(later_->seconds + (now ? now->seconds : 0),
                   later_->at_least || !now || now->at_least);
    }
    const double done = static_cast<double>(finished_) + share;
    if (!(done > 0)) return {};
    return Eta(seconds_since(start_) * (static_cast<double>(steps_) - done) / done);
}

/// By what it took so far, or else by what was expected; empty when neither is known.
std::optional<Eta> StepProgress::remaining_of_step(double share) const {
    const double spent = seconds_since(begun_);
    if (share > 0) return Eta(spent * (1 - share) / share);
    if (!expected_) return {};
    return Eta(std::max(0.0, *expected_ - spent), spent > *expected_);
}

}  // namespace caustics::experiments

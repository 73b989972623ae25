#include "experiments/step_progress.h"

#include "experiments/interrupt.h"

namespace caustics {

void StepProgress::begin(const std::string& what) {
    what_ = what;
    share(0);
}

void StepProgress::share(double done) {
    throw_if_interrupted();
    if (progress_.is_due()) progress_.show(what_, done, remaining(done));
}

void StepProgress::end(const std::string& result) {
    ++finished_;
    progress_.end(what_ + ": " + result, true, remaining(0));
}

std::optional<double> StepProgress::remaining(double share) const {
    const double done = static_cast<double>(finished_) + share;
    if (!(done > 0)) return {};
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count() * (static_cast<double>(steps_) - done) / done;
}

}  // namespace caustics

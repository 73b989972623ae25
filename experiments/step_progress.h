#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "experiments/progress.h"

namespace caustics {

/// The progress of some steps that take about as long as each other, so that those done tell how long the
/// others will take.
class StepProgress {
public:
    explicit StepProgress(std::size_t steps) : progress_(steps, 0), steps_(steps) {}

    /// A step begins.
    void begin(const std::string& what);
    /// The done share of the step. Throws Interrupted when the user asked to stop.
    void share(double done);
    /// The step is over; `result` ends its line.
    void end(const std::string& result);

private:
    std::optional<double> remaining(double share) const;

    Progress progress_;
    std::size_t steps_;
    std::size_t finished_ = 0;
    std::string what_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace caustics

#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include "experiments/base/progress.h"

namespace caustics::experiments {

/// The progress of some steps in a row. Where nothing else is known, steps take about as long as
/// each other, so that those done tell how long the others will take.
class StepProgress {
public:
    explicit StepProgress(std::size_t steps) : progress_(steps, 0), steps_(steps) {}

    /// A step begins. `expected`: the seconds that it will take, if known.
    void begin(const std::string& what, std::optional<double> expected = {});
    /// What the steps after the next one will take, for work whose steps differ much.
    void expect_later(Eta later);
    /// The done share of the step, from any thread. Throws Interrupted when the user asked to stop.
    void share(double done);
    /// The step is over; `result` ends its line. Returns the seconds that it took.
    double end(const std::string& result);

private:
    std::optional<Eta> remaining(double share) const;
    std::optional<Eta> remaining_of_step(double share) const;

    Progress progress_;
    std::size_t steps_;
    std::size_t finished_ = 0;
    std::string what_;
    std::optional<double> expected_;
    std::optional<Eta> later_;
    std::mutex showing_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point begun_ = start_;
};

}  // namespace caustics::experiments

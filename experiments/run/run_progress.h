#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "core/caustic_estimator.h"
#include "experiments/base/status_line.h"

namespace caustics::experiments {

/// The progress of one run on stderr: the phase at work, its done share as a bar, and the seconds
/// that the rest of the phase will take at this pace. Ends with its life: the line is gone then.
class RunProgress {
public:
    /// Takes the callbacks of `options`, for as long as this lives; they throw Interrupted when the
    /// user asked to stop.
    explicit RunProgress(RunOptions& options);

private:
    void begin(std::string_view phase);
    void share(double done);

    StatusLine line_;
    std::mutex showing_;
    std::string phase_ = "precompute";
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    double last_share_ = 0;
};

/// "trace [#####.....] 50 %, phase ETA 0:12" for a phase that has taken so many seconds.
std::string phase_text(const std::string& phase, double share, double seconds);

}  // namespace caustics::experiments

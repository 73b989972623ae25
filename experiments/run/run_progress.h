#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/caustic_estimator.h"
#include "experiments/base/progress.h"
#include "experiments/base/status_line.h"

namespace caustics::experiments {

/// What a run of one or several passes will still take, by what its phases took so far. A pass ends with the phase
/// "render", whose share is that of all passes.
class RunEta {
public:
    explicit RunEta(int passes) : passes_(passes) {}

    /// A phase begins, at a time [s] since the run began.
    void begin(std::string_view phase, double now);
    /// The done share of the phase at a time; of the whole run, or at least that until something of each phase is known.
    std::optional<Eta> at(double share, double now) const;
    /// The pass at work, from 1.
    int pass() const { return rendering_ ? renders_ : renders_ + 1; }

private:
    int passes_;
    int renders_ = 0;  ///< "render" phases that have begun
    bool rendering_ = false;
    double begun_ = 0;          ///< of the phase
    double build_seconds_ = 0;  ///< of all phases but "render" that are over
    double built_ = 0;          ///< build_seconds_ when this pass's build began
    double render_seconds_ = 0;
};

/// The progress of one run on stderr: the phase at work, its done share as a bar, and the seconds that the whole run will
/// still take at this pace. Ends with its life: the line is gone then.
class RunProgress {
public:
    /// Takes the callbacks of `options`, for as long as this lives; they throw Interrupted when the
    /// user asked to stop.
    explicit RunProgress(RunOptions& options, int passes = 1);

private:
    void begin(std::string_view phase);
    void share(double done);
    std::string shown_phase() const;

    StatusLine line_;
    std::mutex showing_;
    std::string phase_ = "precompute";
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    double last_share_ = 0;
    int passes_;
    RunEta eta_;
};

/// "trace [#####.....] 50 %, ETA at least 0:12".
std::string phase_text(const std::string& phase, double share, const std::optional<Eta>& remaining);

}  // namespace caustics::experiments

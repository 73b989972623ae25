#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/caustic_estimator.h"
#include "experiments/base/progress.h"
#include "experiments/base/status_line.h"

namespace caustics::experiments {

/// What a run of one or several passes will still take, by what its phases took so far. A pass ends with the phase
/// "render", whose share is that of all passes.
class RunEta {
public:
    /// `plan` is what the phases of a run of one pass are foretold to take [s]; empty where nothing is.
    explicit RunEta(int passes, std::map<std::string, double> plan = {});

    /// A phase begins, at a time [s] since the run began.
    void begin(std::string_view phase, double now);
    /// The done share of the phase at a time; of the whole run, or at least that until something of each phase is known.
    std::optional<Eta> at(double share, double now) const;
    /// The done share of the whole run at that share of the phase, which never falls: by the plan, or else half of it for each
    /// phase that is left to the build, and the other half for rendering.
    double done(double share);
    /// The pass at work, from 1.
    int pass() const { return rendering_ ? renders_ : renders_ + 1; }

private:
    double planned(const std::string& phase) const;
    double planned_until(double share) const;

    int passes_;
    std::map<std::string, double> plan_;
    double all_ = 0;                 ///< of the plan
    std::vector<std::string> over_;  ///< phases of this pass
    std::string phase_;
    double done_ = 0;
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
    /// `plan` is asked for a run of one pass, where the line is kept up to date.
    explicit RunProgress(RunOptions& options, int passes = 1,
                         const std::function<std::map<std::string, double>()>& plan = {});

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

/// A phase at work and the done share of the whole run: "trace [#####.....] 50 %, ETA at least 0:12".
std::string phase_text(const std::string& phase, double share, const std::optional<Eta>& remaining);

}  // namespace caustics::experiments

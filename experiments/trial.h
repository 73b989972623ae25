#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/reference_cache.h"
#include "experiments/sweep_plan.h"

namespace caustics {

/// What a trial leaves behind.
struct TrialOutcome {
    nlohmann::json record;
    std::optional<Film> film;  ///< of a trial that is done
    std::string log;
};

/// The record of a trial before it ran: its whole configuration, with that status.
nlohmann::json trial_record(const Trial& trial, const std::string& status);

/// Runs one trial and measures it: times per stage (wall and CPU), memory, counters, errors against
/// the reference (may be null). A failure becomes a record of status failed, a scene the method
/// cannot serve one of status unsupported; only Interrupted is thrown. `threads` and progress come
/// from the options.
TrialOutcome run_trial(const Trial& trial, const Reference* reference, const RunOptions& options);

}  // namespace caustics

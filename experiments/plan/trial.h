#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/plan/reference_cache.h"
#include "experiments/plan/sweep_plan.h"

namespace caustics::experiments {

/// What a trial leaves behind.
struct TrialOutcome {
    nlohmann::json record;
    std::optional<Film> film;  ///< of a trial that is done
};

/// Takes a line of a trial's log.
using TrialLog = std::function<void(const std::string& line)>;

/// The record of a trial before it ran: its whole configuration, with that status. Threads and
/// instruction set come from the options.
nlohmann::json trial_record(const Trial& trial, const std::string& status,
                            const RunOptions& options);

/// Puts a picture's errors against its reference into its record, in place of earlier ones.
void record_errors(nlohmann::json& record, const Film& film, const Reference& reference);

/// Runs one trial and measures it: times per stage (wall and CPU), memory, how busy the machine was,
/// counters, errors against its reference. Never throws: a failure becomes a record of status failed,
/// a scene the method cannot serve one of status unsupported, and what is not the trial's own fault (a
/// reference that cannot be read, a scene that changed) one of status left, which is not to be kept.
/// `threads`, instruction set and progress come from the options.
TrialOutcome run_trial(const Trial& trial, ReferenceCache& references, const RunOptions& options,
                       const TrialLog& log);

}  // namespace caustics::experiments

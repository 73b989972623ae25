#pragma once

#include <filesystem>

#include "experiments/plan/reference_cache.h"
#include "experiments/plan/sweep_selection.h"
#include "experiments/sweep/trial_runner.h"

namespace caustics::experiments {

/// What is to be done of a sweep, and how.
struct SweepOptions {
    std::filesystem::path folder;
    Shard shard;                ///< the part of the plan to run
    bool force = false;         ///< run trials again that are done
    bool rerun_failed = false;  ///< run trials again that failed or took too long
    bool fail_fast = false;     ///< stop at the first failure
    ReferencePolicy references = ReferencePolicy::keep;
    bool only_references = false;  ///< render what the trials need, and stop
    TrialSettings trials;
};

}  // namespace caustics::experiments

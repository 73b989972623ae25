#pragma once

#include <filesystem>
#include <string>

#include "experiments/reference_cache.h"
#include "experiments/sweep_plan.h"
#include "experiments/sweep_selection.h"
#include "experiments/trial_runner.h"

namespace caustics {

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

/// Runs what is not there yet, in run_order(), and writes DIR/trials, DIR/records.csv and .jsonl,
/// DIR/plan.json, DIR/environment.json, DIR/references and DIR/report/figures. References come
/// first, one by one on all processors. Prints progress and, at the end, a summary. Returns the exit
/// code: 0, or 1 when there are trials that failed or took too long. Throws Interrupted when asked
/// to stop; what is done is kept. This process starts no thread: everything that may is done in
/// children.
int run_sweep(const SweepPlan& plan, const SweepOptions& options);

}  // namespace caustics

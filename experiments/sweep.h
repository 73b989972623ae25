#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep_plan.h"

namespace caustics {

struct SweepOptions {
    std::filesystem::path folder;
    bool force = false;               ///< run trials again that are done
    bool fail_fast = false;           ///< stop at the first failure
    bool rebuild_references = false;  ///< render references anew
    int threads = 0;                  ///< of a trial; 0: as the sweep file says
    Isa isa = widest_isa();           ///< of the trials
};

/// Runs what is not done yet (failed trials count as not done), one trial after the other, and
/// writes DIR/trials, DIR/records.csv, DIR/environment.json, DIR/references and DIR/report/figures.
/// Prints progress and, at the end, a summary. Returns the exit code: 0, or 1 when trials failed.
/// Throws Interrupted when asked to stop; what is done is kept.
int run_sweep(const SweepPlan& plan, const SweepOptions& options);

/// One line a trial: its status (done, failed, unsupported, or todo) and id.
std::string list_plan(const SweepPlan& plan, const std::filesystem::path& folder);

}  // namespace caustics

#pragma once

#include "experiments/plan/sweep_plan.h"
#include "experiments/sweep/sweep_options.h"

namespace caustics::experiments {

/// Runs what is not there yet, in run_order(), and writes DIR/trials, DIR/records.csv and .jsonl,
/// DIR/plan.json, DIR/environment.json, DIR/references and DIR/report/figures. References come
/// first, one by one on all processors. Prints progress and, at the end, a summary. Returns the exit
/// code: 0, or 1 when there are trials that failed or took too long. Throws Interrupted when asked
/// to stop; what is done is kept. This process starts no thread: everything that may is done in
/// children.
int run_sweep(const SweepPlan& plan, const SweepOptions& options);

}  // namespace caustics::experiments

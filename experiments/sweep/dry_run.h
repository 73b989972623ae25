#pragma once

#include <string>

#include "experiments/sweep/sweep.h"

namespace caustics::experiments {

/// One line a trial of the shard: its status (done, failed, timeout, unsupported, or todo) and id.
std::string list_plan(const SweepPlan& plan, const SweepOptions& options);

/// What run_sweep would do: trials, references, and time and disk as far as earlier records tell.
std::string dry_run(const SweepPlan& plan, const SweepOptions& options);

}  // namespace caustics::experiments

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/plan/sweep_plan.h"

namespace caustics::experiments {

/// Part `index` of `count`, from 1.
struct Shard {
    int index = 1;
    int count = 1;
};

/// Reads "2/5", or "auto": the task's place in its Slurm job array (SLURM_ARRAY_TASK_ID, _MIN, _MAX
/// and _COUNT; arrays without gaps that begin at 0 or 1). Throws InputError.
Shard parse_shard(const std::string& text);

/// Chooses the trials that all filters "key=value" fit; several filters on the same key are
/// alternatives. Keys are trial, scene, method, seed, repeat and the swept ones; a trial that has no
/// such key does not fit. Throws InputError for an unknown key and for a value that no trial has.
void choose(SweepPlan& plan, const std::vector<std::string>& filters);

/// The chosen trials in the order to run them: first all of repeat 1, then repeat 2, and so on, within each
/// in an order that looks random but is the same every time, so that methods and seeds are
/// interleaved and no drift of the machine favours one of them.
std::vector<const Trial*> run_order(const SweepPlan& plan);

/// Every count-th of the trials, from the index-th on: the shards of a plan share it out, each trial
/// once.
std::vector<const Trial*> shard_of(const std::vector<const Trial*>& trials, const Shard& shard);

}  // namespace caustics::experiments

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/plan/reference_cache.h"
#include "experiments/plan/sweep_plan.h"
#include "experiments/plan/trial_store.h"

namespace caustics::experiments {

/// Writes FOLDER/ID.png, the strip reference | picture | signed error of the caustic, for the first
/// done trial of each cell, where it is missing or older than the picture; in a child process. Returns
/// a line on those that cannot be drawn because a picture or a reference is gone or broken, if any.
std::vector<std::string> write_strips(const SweepPlan& plan, const TrialStore& store,
                                      const std::function<bool(const Trial&)>& is_done,
                                      ReferenceCache& references,
                                      const std::filesystem::path& folder);

}  // namespace caustics::experiments

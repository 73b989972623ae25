#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/sweep/sweep_options.h"
#include "experiments/sweep/sweep_status.h"

namespace caustics::experiments {

/// What a user should know before the sweep runs, a line each: trials of `others` that the table leaves out, other
/// code than before, trials named twice or failed before, and more threads than processors.
std::vector<std::string> sweep_warnings(const SweepPlan& plan, const SweepOptions& options,
                                        const SweepStatus& status, std::size_t others);

}  // namespace caustics::experiments

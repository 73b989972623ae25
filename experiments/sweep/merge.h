#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace caustics::experiments {

/// Puts the results of shards together: trials, references, figures, tables. Throws InputError,
/// having written nothing, when a runner still works on one of the folders, when they hold
/// different plans, when a trial of the plan is in none of them or in two, when their records come
/// from different code or instruction sets, when a file is broken or none, or when `target` is there
/// already. Returns warnings, a line each: records from different processors, pictures that are gone.
std::vector<std::string> merge_results(const std::vector<std::filesystem::path>& folders,
                                       const std::filesystem::path& target);

}  // namespace caustics::experiments

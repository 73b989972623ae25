#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace caustics::experiments {

/// The records and references that a merge put together.
struct Merged {
    std::map<std::filesystem::path, std::size_t> trials;  ///< by the folder that they came from
    std::map<std::string, std::size_t> statuses;
    std::size_t references = 0;
    std::size_t repeated_references = 0;  ///< that a further folder has too
    std::vector<std::string> warnings;    ///< a line each
};

/// Puts the results of shards together: trials, references, figures, tables. Throws InputError,
/// having written nothing, when a runner still works on one of the folders, when they hold
/// different plans, when a trial of the plan is in none of them or in two, when their records come
/// from different code or instruction sets, when a file is broken or none, or when `target` is there
/// already. Warnings: records from different processors, pictures that are gone.
Merged merge_results(const std::vector<std::filesystem::path>& folders,
                     const std::filesystem::path& target);

}  // namespace caustics::experiments

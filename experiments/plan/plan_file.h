#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plan/sweep_plan.h"

namespace caustics::experiments {

/// DIR/plan.json: what a sweep set out to do, for tables, `merge` and `explain`, which see no sweep
/// file. A shard's plan is that of all shards together.
struct PlanFile {
    struct Entry {
        std::string id;
        std::string cell;
        std::uint64_t seed = 1;
        bool chosen = true;  ///< by the filters
        friend bool operator==(const Entry&, const Entry&) = default;
    };
    std::vector<Entry> trials;         ///< in the order of the table
    std::vector<std::string> swept;    ///< columns after those of every trial
    std::vector<std::string> sweeps;   ///< the sweep files
    std::vector<std::string> filters;  ///< "key=value"
    std::filesystem::path started_in;  ///< relative file names are relative to this folder
};

PlanFile plan_file(const SweepPlan& plan);

void write_plan(const PlanFile& plan, const std::filesystem::path& folder);
/// Throws InputError when the folder holds no results of a sweep, or its plan is broken.
PlanFile read_plan_of(const std::filesystem::path& folder);

}  // namespace caustics::experiments

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "experiments/job_store.h"
#include "experiments/reference_cache.h"
#include "experiments/sweep_plan.h"

namespace caustics {

/// Writes records.csv from the records of a plan's trials, in the plan's order. Trials of a cell
/// that differ in their seed share `variance`: the mean over reached pixels and channels of the
/// sample variance of the caustic over the seeds.
void write_records_csv(const SweepPlan& plan, const JobStore& store,
                       const std::vector<nlohmann::json>& records,
                       const std::filesystem::path& file);

/// Writes FOLDER/ID.png, the strip reference | picture | signed error of the caustic, for the first
/// done trial of each cell, where it is missing or the trial is in `fresh`.
void write_figures(const SweepPlan& plan, const JobStore& store,
                   const std::vector<nlohmann::json>& records, const std::set<std::string>& fresh,
                   ReferenceCache& references, const RunOptions& options,
                   const std::filesystem::path& folder);

/// Five lines on what a sweep found.
std::string summary(const std::vector<nlohmann::json>& records, std::size_t planned,
                    std::size_t ran, double seconds);

}  // namespace caustics

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/job_store.h"
#include "experiments/plan_file.h"

namespace caustics {

/// Writes FOLDER/records.csv and records.jsonl anew from the trials that are there, one row a trial
/// in the plan's order, reading one record at a time. `visit` sees each. Trials of a cell that
/// differ in their seed share `variance`: the mean over reached pixels and channels of the sample
/// variance of the caustic over the seeds; it is computed in a child process, or taken from the
/// table that is there when the same trials made it. `unfinished` are rows of trials that left
/// nothing.
void write_records(const std::filesystem::path& folder, const JobStore& store, const PlanFile& plan,
                   const std::map<std::string, nlohmann::json>& unfinished,
                   const std::function<void(const nlohmann::json& record)>& visit);

}  // namespace caustics

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "experiments/report/table_row.h"

namespace caustics::experiments {

/// Makes FOLDER/records.csv and records.jsonl say what the trials that are there say, one row a
/// trial in the plan's order: leaves them when they do already, else writes them anew, reading one
/// record at a time. `visit` sees each row. Returns what the tables lack because pictures are gone, a
/// line each. Trials of a cell that differ in their seed share
/// `variance` (cell_variances). `unfinished` are records of trials that left nothing.
std::vector<std::string> write_records(const std::filesystem::path& folder, const TrialStore& store,
                                       const PlanFile& plan,
                                       const std::map<std::string, nlohmann::json>& unfinished,
                                       const std::function<void(const TableRow& row)>& visit);

}  // namespace caustics::experiments

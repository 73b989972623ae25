#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "experiments/job_store.h"
#include "experiments/plan_file.h"

namespace caustics {

/// When each done trial ended, by id: tells whether a picture is still the same.
using DoneTrials = std::map<std::string, std::string>;

/// By cell: the mean over reached pixels and channels of the sample variance of the caustic over the
/// seeds of the cell's done trials (repeats show the same picture again and are left out). Taken
/// from the table `records.jsonl` of an earlier run where the same trials made it; else computed
/// from the pictures, in a child process.
std::map<std::string, double> cell_variances(const PlanFile& plan, const JobStore& store,
                                             const DoneTrials& done,
                                             const std::filesystem::path& earlier_table);

}  // namespace caustics

#pragma once

#include <map>
#include <optional>
#include <string>

#include "experiments/job_store.h"
#include "experiments/plan_file.h"

namespace caustics {

/// How the pictures of a cell vary, one for each seed (repeats show the same picture again).
struct CellVariance {
    std::string pictures;  ///< hash of those it was computed from
    /// Mean over reached pixels and channels of the sample variance of the caustic; empty when no
    /// pixel is reached.
    std::optional<double> mean;
    std::string unreadable = {};  ///< why there is none: a picture that is gone or broken
};

/// By cell; cells of fewer than two seeds have none.
using CellVariances = std::map<std::string, CellVariance>;

/// The hash of the picture of each done trial, by id.
using DonePictures = std::map<std::string, std::string>;

/// Those of a plan's cells: as they were where the pictures are the same, else computed from the
/// pictures in a child process. A picture that cannot be read leaves its cell without. Cells to
/// compute are left out once somebody asked to stop.
CellVariances cell_variances(const PlanFile& plan, const JobStore& store, const DonePictures& done,
                             const CellVariances& earlier);

}  // namespace caustics

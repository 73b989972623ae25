#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "experiments/plan/plan_file.h"

namespace caustics::experiments {

/// How the pictures of a cell vary, one for each seed (repeats show the same picture again).
struct CellVariance {
    std::string pictures;  ///< hash of those it was computed from
    /// Mean of the sample variance of the caustic, over the channels of the pixels that errors count
    /// too: those that neither a picture of the cell nor its reference marks `unreached`. Empty when
    /// there is no such pixel, and where the reference cannot be found.
    std::optional<double> mean;
    std::string unreadable = {};  ///< why there is none: a picture that is gone or broken
};

/// By cell; cells of fewer than two seeds have none.
using CellVariances = std::map<std::string, CellVariance>;

/// What a done trial's record says of its picture.
struct DonePicture {
    std::string hash;
    std::string reference;  ///< its key; empty: there is none
};
/// By id of the trial.
using DonePictures = std::map<std::string, DonePicture>;

/// Those of a plan's cells, whose trials and references lie in `folder`: as they were where the
/// pictures are the same, else computed from the pictures in a child process. A picture that cannot
/// be read leaves its cell without. Cells to compute are left out once somebody asked to stop.
CellVariances cell_variances(const PlanFile& plan, const std::filesystem::path& folder,
                             const DonePictures& done, const CellVariances& earlier);

}  // namespace caustics::experiments

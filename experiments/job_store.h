#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/trial.h"

namespace caustics {

/// The folder of finished trials, DIR/trials/ID/{record.json, image.exr, log.txt}. A trial's folder
/// is whole or absent: it is written under a temporary name and renamed.
class JobStore {
public:
    /// Makes the folders; removes what killed processes left half-written. Throws InputError when
    /// it cannot be written.
    explicit JobStore(const std::filesystem::path& folder);

    /// The record of a finished trial. Throws InputError when it is there but broken.
    std::optional<nlohmann::json> record(const std::string& id) const;
    std::filesystem::path image_of(const std::string& id) const;
    /// Adds a finished trial, replacing an earlier one of that id.
    void add(const std::string& id, const TrialOutcome& outcome) const;

private:
    void remove_leftovers() const;

    std::filesystem::path trials_;
};

}  // namespace caustics

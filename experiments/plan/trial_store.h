#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace caustics::experiments {

/// A file that was read and is no record of its trial.
class BrokenRecord : public InputError {
public:
    using InputError::InputError;
};

/// The folder of finished trials, DIR/trials/ID/{record.json, image.exr, log.txt}. A trial's folder
/// is whole or absent: it is filled under a temporary name, brought to the disk and renamed.
/// Whoever writes holds the FolderLock of DIR.
class TrialStore {
public:
    explicit TrialStore(const std::filesystem::path& folder) : trials_(folder / "trials") {}

    /// Makes the folder ready for writing: removes what killed processes left half-written, and
    /// brings back what they were about to replace. Throws InputError when it cannot be written.
    void prepare() const;

    /// The record of a finished trial. Throws BrokenRecord when it is there but none, and InputError
    /// when it cannot be read.
    std::optional<nlohmann::json> record(const std::string& id) const;
    /// The ids of all that are there, in no order.
    std::vector<std::string> trials() const;
    std::filesystem::path folder_of(const std::string& id) const { return trials_ / id; }
    std::filesystem::path record_of(const std::string& id) const {
        return trials_ / id / "record.json";
    }
    std::filesystem::path image_of(const std::string& id) const {
        return trials_ / id / "image.exr";
    }

    /// An empty folder to write a trial's files into, temporary_of(id).
    std::filesystem::path begin(const std::string& id) const;
    /// Adds the record and makes that folder the trial's, in place of an earlier one; all of it is
    /// on the disk then.
    void commit(const std::string& id, const nlohmann::json& record) const;
    /// Forgets that folder; what cannot be removed, prepare() will.
    void drop(const std::string& id) const noexcept;
    std::filesystem::path temporary_of(const std::string& id) const;
    /// Removes a trial.
    void remove(const std::string& id) const;

private:
    std::filesystem::path trials_;
};

}  // namespace caustics::experiments

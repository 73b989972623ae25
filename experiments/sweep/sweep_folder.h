#pragma once

#include <filesystem>

#include "experiments/base/folder_lock.h"
#include "experiments/plan/trial_store.h"

namespace caustics::experiments {

/// A folder of results, taken for this process and rid of what killed ones left half-written. Throws
/// InputError when another process works on it, or it cannot be written.
class SweepFolder {
public:
    explicit SweepFolder(const std::filesystem::path& folder);

    /// Throws InputError where the path leads to another folder by now.
    void require_same() const { lock_.require_same_folder(); }
    const TrialStore& store() const { return store_; }
    std::filesystem::path figures() const { return folder_ / "report" / "figures"; }
    std::filesystem::path references() const { return folder_ / "references"; }

private:
    std::filesystem::path folder_;
    FolderLock lock_;
    TrialStore store_;
};

}  // namespace caustics::experiments

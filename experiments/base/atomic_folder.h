#pragma once

#include <filesystem>
#include <optional>

#include "experiments/base/folder_lock.h"

namespace caustics::experiments {

/// A folder of files that are all there or not at all: they are written into TARGET.part, which
/// commit() renames. Without commit() nothing is left behind; what a killed process left there, the
/// next one for that target removes. Throws std::filesystem::filesystem_error where the system
/// refuses.
class AtomicFolder {
public:
    /// Throws InputError also when another process is at work on that target.
    explicit AtomicFolder(const std::filesystem::path& target);
    ~AtomicFolder();
    AtomicFolder(const AtomicFolder&) = delete;
    AtomicFolder& operator=(const AtomicFolder&) = delete;

    /// To write into.
    const std::filesystem::path& path() const { return temporary_; }
    /// Makes it the target, and brings that to the disk. In a target that is a link or holds something
    /// already, files of the same names are replaced and others stay.
    void commit();

private:
    void put_in_place() const;

    std::filesystem::path target_;     ///< absolute
    std::filesystem::path temporary_;  ///< empty once it is the target
    std::optional<FolderLock> lock_;
};

}  // namespace caustics::experiments

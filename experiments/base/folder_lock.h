#pragma once

#include <filesystem>
#include <string>

namespace caustics::experiments {

/// Keeps a folder of results for this process: a lock of the system on FOLDER/.lock, which ends with
/// the process, however that ends, and is not passed on to children.
class FolderLock {
public:
    /// Makes the folder where it is missing. Throws InputError when another process has it, naming
    /// that process, or when the folder cannot be written.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Throws InputError where the path no longer leads to this lock: the folder was renamed, removed or made
    /// anew while the process worked on it, or its .lock was.
    void require_same_folder() const;

private:
    std::filesystem::path folder_;
    int file_ = -1;
};

/// The error line where the system refuses a lock on the folder with this errno, and what to do.
std::string why_not_locked(const std::filesystem::path& folder, int error);

/// "process 12 on host" where another process holds the lock of a folder; else empty. Needs no
/// leave to write there. Throws InputError when the lock is there but cannot be looked at.
std::string runner_at_work_on(const std::filesystem::path& folder);

}  // namespace caustics::experiments

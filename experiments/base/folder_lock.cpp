#include "experiments/base/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/base/disk.h"
#include "core/base/error.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

std::string reason(int error) { return std::generic_category().message(error); }

std::filesystem::path lock_file(const std::filesystem::path& folder) { return folder / ".lock"; }

/// Of the process, not of the open file (as flock is): an orphaned child must not hold it.
struct flock whole_file_lock() {
    struct flock lock{};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    return lock;
}

}  // namespace

std::string runner_at_work_on(const std::filesystem::path& folder) {
    const std::filesystem::path name = lock_file(folder);
    const int file = open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0 && (errno == ENOENT || errno == ENOTDIR)) return {};
    if (file < 0)
        throw InputError(fmt::format("{}: cannot be read ({})", name.string(), reason(errno)));
    struct flock lock = whole_file_lock();
    const bool held = fcntl(file, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
    close(file);
    return held ? read_whole_file(name) : std::string();
}

std::string why_not_locked(const std::filesystem::path& folder, int error) {
    const bool has_none =
        error == ENOLCK || error == EOPNOTSUPP || error == ENOSYS || error == EINVAL;
    return fmt::format("{}: cannot be locked ({}){}", lock_file(folder).string(), reason(error),
                       has_none
                           ? "; its file system has no locks, as a network file system without "
                             "a lock service: write to a folder on a local disk and copy it there"
                           : "");
}

FolderLock::FolderLock(const std::filesystem::path& folder) : folder_(folder) {
    namespace fs = std::filesystem;
    const auto is_there = [](const fs::path& path) {
        std::error_code none;
        return fs::exists(fs::symlink_status(path, none));
    };
    const fs::path name = lock_file(folder);
    const bool was_there = is_there(folder);
    const bool was_locked_before = is_there(name);
    // What is made here goes again where the lock cannot be written.
    const auto fail_to_write = [&](int error) {
        std::error_code none;
        if (!was_locked_before) fs::remove(name, none);
        if (!was_there) fs::remove(folder, none);
        if (file_ >= 0) close(file_);
        const fs::path& place = was_locked_before ? name : folder;
        throw InputError(fmt::format("{}: cannot be written ({})", place.string(), reason(error)));
    };
    try {
        make_folders(folder);
    } catch (const std::filesystem::filesystem_error& error) {
        throw InputError(
            fmt::format("{}: cannot be made ({})", folder.string(), error.code().message()));
    }
    // Its content is replaced: a link in a folder from elsewhere must not lead to another file.
    file_ = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0 && errno == ELOOP)
        throw InputError(fmt::format("{}: is a symbolic link, not a lock", name.string()));
    if (file_ < 0) fail_to_write(errno);

    const struct flock lock = whole_file_lock();
    if (fcntl(file_, F_SETLK, &lock) != 0) {
        const int refusal = errno;
        close(file_);
        if (refusal != EACCES && refusal != EAGAIN)
            throw InputError(why_not_locked(folder, refusal));
        throw InputError(
            fmt::format("{}: another runner works on it ({}); wait for it, or use a folder of its "
                        "own and merge "
                        "them (see sweep --shard)",
                        folder.string(), read_whole_file(name)));
    }
    const std::string owner = fmt::format("process {} on {}", getpid(), host_name());
    // Says who it is; the lock itself does not depend on it.
    if (ftruncate(file_, 0) != 0 || pwrite(file_, owner.data(), owner.size(), 0) < 0)
        fail_to_write(errno);
}

FolderLock::~FolderLock() { close(file_); }

void FolderLock::require_same_folder() const {
    std::error_code none;
    struct stat held{}, there{};
    if (fstat(file_, &held) == 0 && stat(lock_file(folder_).c_str(), &there) == 0 &&
        held.st_dev == there.st_dev && held.st_ino == there.st_ino)
        return;
    const bool is_folder_there = std::filesystem::is_directory(folder_, none);
    if (held.st_nlink == 0 && is_folder_there)
        throw InputError(fmt::format(
            "{}: is not the one that this process holds: it was removed, alone or with its folder, "
            "while the process worked there; nothing more is written there. The same command goes "
            "on from what is there",
            lock_file(folder_).string()));
    throw InputError(fmt::format(
        "{}: was renamed, removed or made anew while this process worked on it; nothing "
        "more is written there. What was finished stays in the renamed folder: name "
        "that by -o to go on",
        folder_.string()));
}

}  // namespace caustics::experiments

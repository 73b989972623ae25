#include "experiments/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"
#include "experiments/environment.h"
#include "experiments/files.h"

namespace caustics {

namespace {

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
    const std::filesystem::path name = folder / ".lock";
    file_ = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0)
        throw InputError(fmt::format("{}: cannot be written ({})", folder.string(), reason(errno)));

    // Of the process, not of the open file (as flock is): an orphaned child must not hold it.
    struct flock lock{};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    if (fcntl(file_, F_SETLK, &lock) != 0) {
        const int refusal = errno;
        close(file_);
        if (refusal != EACCES && refusal != EAGAIN)
            throw InputError(
                fmt::format("{}: cannot be locked ({})", name.string(), reason(refusal)));
        throw InputError(
            fmt::format("{}: another runner works on it ({}); wait for it, or use a folder of its "
                        "own and merge "
                        "them (see sweep --shard)",
                        folder.string(), read_whole_file(name)));
    }
    const std::string owner = fmt::format("process {} on {}", getpid(), host_name());
    // Says who it is; the lock itself does not depend on it.
    if (ftruncate(file_, 0) != 0 || pwrite(file_, owner.data(), owner.size(), 0) < 0) {
        const int refusal = errno;
        close(file_);
        throw InputError(
            fmt::format("{}: cannot be written ({})", folder.string(), reason(refusal)));
    }
}

FolderLock::~FolderLock() { close(file_); }

}  // namespace caustics

#include "core/base/disk.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/error.h"

namespace caustics {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_sync(const fs::path& place, int error) {
    throw InputError(place.string() + ": cannot be written (" +
                     std::generic_category().message(error) + ")");
}

}  // namespace

fs::path folder_above(const fs::path& place) {
    return place.has_parent_path() ? place.parent_path() : fs::path(".");
}

void bring_to_disk(int descriptor, const fs::path& place) {
    // EINVAL: a file system that cannot be asked to; it writes when it likes.
    if (fsync(descriptor) != 0 && errno != EINVAL) fail_to_sync(place, errno);
}

void bring_to_disk(const fs::path& place) {
    const int descriptor = open(place.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    // A folder that may be written into, but not read.
    if (descriptor < 0 && errno == EACCES && fs::is_directory(place)) return;
    if (descriptor < 0) fail_to_sync(place, errno);
    try {
        bring_to_disk(descriptor, place);
    } catch (...) {
        close(descriptor);
        throw;
    }
    close(descriptor);
}

void make_folders(const fs::path& folder) {
    std::vector<fs::path> missing;
    std::error_code unknown;
    for (fs::path each = folder; !each.empty() && !fs::exists(each, unknown) && !unknown;
         each = each.parent_path())
        missing.push_back(each);
    fs::create_directories(folder);
    for (const fs::path& each : missing) bring_to_disk(folder_above(each));
}

}  // namespace caustics

#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/disk.h"
#include "core/base/error.h"
#include "core/base/hash.h"

namespace caustics {

namespace {

std::filesystem::path entry_of(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

/// A new file of that name, in place of what a killed process may have left; a link is not followed.
int open_named(const std::filesystem::path& file) {
    constexpr mode_t mode = 0666;
    unlink(file.c_str());
    return open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, mode);
}

/// A file without a name in the folder, which a killed process leaves nothing of; -1 where the file
/// system has no such files, or it could not be given a name later.
int open_nameless(const std::filesystem::path& folder) {
    constexpr mode_t mode = 0666;
    const int descriptor = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
    std::error_code none;
    if (descriptor < 0 || std::filesystem::exists(entry_of(descriptor), none)) return descriptor;
    close(descriptor);
    return -1;
}

/// Beside the file, so that renaming stays on its file system.
std::filesystem::path temporary_name(const std::filesystem::path& file) {
    constexpr std::size_t longest = 255;
    const std::string mark = ".tmp-" + std::to_string(getpid());
    const std::string name = file.filename();
    const bool fits = name.size() + mark.size() <= longest;
    return file.parent_path() / ((fits ? name : std::to_string(fnv1a(name))) + mark);
}

std::string reason_of(int error) { return std::generic_category().message(error); }

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& file)
    : file_(file), temporary_(temporary_name(file)) {
    std::error_code unknown;
    if (std::filesystem::is_other(file, unknown)) fail(EEXIST);
    out_ = open_nameless(folder_above(file));
    is_nameless_ = out_ >= 0;
    if (!is_nameless_) out_ = open_named(temporary_);
    if (out_ < 0) fail(errno);
}

AtomicFile::~AtomicFile() {
    if (out_ >= 0) close(out_);
    // Not std::filesystem's, which may want memory.
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::fail(int error) const {
    throw InputError(file_.string() + ": cannot be written (" + reason_of(error) + ")");
}

void AtomicFile::put(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t written = ::write(out_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::write(std::string_view bytes) {
    constexpr std::size_t block = 1 << 16;
    if (waiting_.size() + bytes.size() < block) {
        waiting_ += bytes;
        return;
    }
    put(waiting_);
    waiting_.clear();
    put(bytes);
}

/// Another process of that number may have left the name behind.
void AtomicFile::name() {
    std::error_code none;
    std::filesystem::remove(temporary_, none);
    const std::filesystem::path entry = entry_of(out_);
    if (linkat(AT_FDCWD, entry.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0)
        fail(errno);
}

void AtomicFile::commit() {
    put(waiting_);
    // First the content, then its name: a disk may take them in any order.
    bring_to_disk(out_, file_);
    if (is_nameless_) name();
    if (close(std::exchange(out_, -1)) != 0) fail(errno);
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) fail(error.value());
    temporary_.clear();
    bring_to_disk(folder_above(file_));
}

void require_writable_place(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    const fs::path folder = folder_above(file);
    const auto fail = [&](const std::string& why) { throw InputError(file.string() + ": " + why); };
    std::error_code unknown;
    if (!fs::is_directory(folder, unknown))
        fail("the folder " + folder.string() + " does not exist");
    if (fs::is_symlink(fs::symlink_status(file, unknown)))
        fail("is a symbolic link, which a new file would replace; name the file it leads to");
    const fs::file_status status = fs::status(file, unknown);
    if (unknown == std::errc::filename_too_long)
        fail("cannot be written (" + unknown.message() + ")");
    if (fs::is_directory(status)) fail("is a folder, not a file");
    if (fs::exists(status) && !fs::is_regular_file(status)) fail("is no regular file");
    if (faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
        fail("cannot be written (" + reason_of(errno) + ")");
}

void write_atomic_file(const std::filesystem::path& file, std::string_view bytes) {
    AtomicFile out(file);
    out.write(bytes);
    out.commit();
}

void require_regular_file(const std::filesystem::path& file) {
    const auto fail = [&](const std::string& why) {
        throw InputError(file.string() + ": cannot be read (" + why + ")");
    };
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) fail("no such file");
    if (!std::filesystem::status_known(status)) fail(error.message());
    if (std::filesystem::is_directory(status)) fail("it is a folder, not a regular file");
    if (!std::filesystem::is_regular_file(status))
        fail("a pipe or device, not a regular file: write its content to a file first");
}

std::string read_whole_file(const std::filesystem::path& file) {
    require_regular_file(file);
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    try {
        std::string bytes(in ? static_cast<std::size_t>(in.tellg()) : 0, '\0');
        in.seekg(0);
        in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (in) return bytes;
    } catch (const std::bad_alloc&) {
        throw InputError(file.string() + ": does not fit into memory");
    }
    throw InputError(file.string() + ": cannot be read (" + reason_of(errno) + ")");
}

}  // namespace caustics

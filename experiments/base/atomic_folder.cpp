#include "experiments/base/atomic_folder.h"

#include <fmt/format.h>

#include "core/base/disk.h"
#include "core/base/error.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = ".lock";  ///< of FolderLock

/// Without "." and "..", and without a slash at the end.
fs::path normal_target(const fs::path& target) {
    const fs::path whole = fs::absolute(target).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

/// Whether it can have been left by a killed process.
bool is_part(const fs::path& folder) {
    return fs::is_directory(fs::symlink_status(folder)) &&
           (fs::is_empty(folder) || fs::exists(folder / lock_name));
}

/// All but the lock, whose name is on the disk before the first other and after the last: so it
/// tells what is left of a crash.
void clear(const fs::path& folder) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.path().filename() != lock_name) fs::remove_all(entry.path());
    bring_to_disk(folder);
}

/// Of folders in it as well. Not by the library's recursive iterator, which ends the process where it
/// finds no memory.
void bring_all_to_disk(const fs::path& folder) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_directory() && !entry.is_symlink())
            bring_all_to_disk(entry.path());
        else
            bring_to_disk(entry.path());
    bring_to_disk(folder);
}

}  // namespace

AtomicFolder::AtomicFolder(const fs::path& target)
    : target_(normal_target(target)), temporary_(target_.string() + ".part") {
    if (fs::exists(fs::symlink_status(temporary_)) && !is_part(temporary_))
        throw InputError(
            fmt::format("{}: is in the way of {}", temporary_.string(), target.string()));
    lock_.emplace(temporary_);
    clear(temporary_);
}

AtomicFolder::~AtomicFolder() {
    if (temporary_.empty()) return;
    try {
        clear(temporary_);
        fs::remove_all(temporary_);
    } catch (const std::exception&) {}  // the next one for that target tries again
}

void AtomicFolder::commit() {
    bring_all_to_disk(temporary_);
    const bool stays = fs::is_symlink(target_) || (fs::exists(target_) && !fs::is_empty(target_));
    if (stays) {
        for (const fs::directory_entry& entry : fs::directory_iterator(temporary_))
            if (entry.path().filename() != lock_name)
                fs::rename(entry.path(), target_ / entry.path().filename());
        bring_to_disk(target_);
        fs::remove_all(temporary_);
    } else {
        put_in_place();
    }
    temporary_.clear();
}

void AtomicFolder::put_in_place() const {
    std::error_code ignored;
    fs::rename(temporary_, target_);
    try {
        bring_to_disk(folder_above(target_));
    } catch (...) {
        fs::rename(target_, temporary_, ignored);
        throw;
    }
    fs::remove(target_ / lock_name, ignored);
}

}  // namespace caustics::experiments

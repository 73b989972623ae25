#include "experiments/base/atomic_folder.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = ".lock";  ///< of FolderLock

/// Without "." and "..", and without a slash at the end.
fs::path plain(const fs::path& target) {
    const fs::path whole = fs::absolute(target).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

/// Whether it can have been left by a killed process.
bool is_part(const fs::path& folder) {
    return fs::is_directory(folder) && (fs::is_empty(folder) || fs::exists(folder / lock_name));
}

}  // namespace

AtomicFolder::AtomicFolder(const fs::path& target)
    : target_(plain(target)), temporary_(target_.string() + ".part") {
    if (fs::exists(temporary_) && !is_part(temporary_))
        throw InputError(
            fmt::format("{}: is in the way of {}", temporary_.string(), target.string()));
    lock_.emplace(temporary_);
    for (const fs::directory_entry& entry : fs::directory_iterator(temporary_))
        if (entry.path().filename() != lock_name) fs::remove_all(entry.path());
}

AtomicFolder::~AtomicFolder() {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void AtomicFolder::commit() {
    fs::remove(temporary_ / lock_name);
    const bool stays = fs::is_symlink(target_) || (fs::exists(target_) && !fs::is_empty(target_));
    if (stays) {
        for (const fs::directory_entry& entry : fs::directory_iterator(temporary_))
            fs::rename(entry.path(), target_ / entry.path().filename());
        fs::remove(temporary_);
    } else {
        fs::rename(temporary_, target_);
    }
    temporary_.clear();
}

}  // namespace caustics::experiments

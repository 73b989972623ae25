#include "experiments/sweep/sweep_folder.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view temporary_mark = ".tmp-";  ///< of AtomicFile

/// Removes files that killed processes left under temporary names.
void remove_leftovers(const fs::path& folder) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
        if (entry.is_regular_file() &&
            entry.path().filename().string().find(temporary_mark) != std::string::npos)
            fs::remove(entry.path(), ignored);
}

/// What is written into results, and removed from them, stays there, whoever made the folder. Only
/// `references` may be a link: shards share them.
void require_own_folders(const fs::path& results) {
    for (const char* name : {"trials", "report", "report/figures"})
        if (fs::is_symlink(results / name))
            throw InputError(
                fmt::format("{}: is a symbolic link, and results are kept in their own "
                            "folder (make a link to the whole folder instead)",
                            (results / name).string()));
}

}  // namespace

SweepFolder::SweepFolder(const fs::path& folder) : folder_(folder), lock_(folder), store_(folder) {
    require_own_folders(folder);
    store_.prepare();
    remove_leftovers(folder);
    remove_leftovers(figures());
    // Shards may share a folder of references, where others are at work.
    if (!fs::is_symlink(references())) remove_leftovers(references());
}

}  // namespace caustics::experiments

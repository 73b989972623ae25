#include "experiments/sweep/sweep_folder.h"

#include <string_view>
#include <system_error>

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

}  // namespace

SweepFolder::SweepFolder(const fs::path& folder) : folder_(folder), lock_(folder), store_(folder) {
    store_.prepare();
    remove_leftovers(folder);
    remove_leftovers(figures());
    // Shards may share a folder of references, where others are at work.
    if (!fs::is_symlink(references())) remove_leftovers(references());
}

}  // namespace caustics::experiments

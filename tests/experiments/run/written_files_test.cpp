#include "experiments/run/written_files.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

// A link to itself has no place of its own.
TEST(WrittenFiles, AreOneFileWhereTheirNameLeadsNowhere) {
    const support::TemporaryFolder folder;
    std::filesystem::create_symlink("loop", folder / "loop");
    const std::string a = folder / "loop/a.exr";
    const std::string b = folder / "loop/b.exr";
    EXPECT_NO_THROW(require_files_apart({a, b}, {}, {}));
    EXPECT_THROW(require_files_apart({a, folder / "loop/./a.exr"}, {}, {}), InputError);
    EXPECT_THROW(require_files_apart({a}, {}, {std::string(folder / "loop/x/../a.exr")}),
                 InputError);
}

}  // namespace
}  // namespace caustics::experiments

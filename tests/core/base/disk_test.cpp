#include "core/base/disk.h"

#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

TEST(Disk, TakesFilesAndFoldersAndNamesWhatIsNotThere) {
    const support::TemporaryFolder folder;
    write_atomic_file(folder / "file", "content");
    EXPECT_NO_THROW(bring_to_disk(folder / "file"));
    EXPECT_NO_THROW(bring_to_disk(folder.path()));
    try {
        bring_to_disk(folder / "absent");
        FAIL() << "there is nothing to bring";
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  (folder / "absent").string() + ": cannot be written (No such file or directory)");
    }
}

TEST(Disk, MakesEveryFolderThatIsMissing) {
    const support::TemporaryFolder folder;
    make_folders(folder / "a/b/c");
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
    EXPECT_NO_THROW(make_folders(folder / "a/b/c/")) << "is there already";
    write_atomic_file(folder / "file", "");
    EXPECT_THROW(make_folders(folder / "file/a"), std::filesystem::filesystem_error);
}

TEST(Disk, KnowsTheFolderAbove) {
    EXPECT_EQ(folder_above("a/b"), "a");
    EXPECT_EQ(folder_above("a"), ".");
    EXPECT_EQ(folder_above("/a"), "/");
}

}  // namespace
}  // namespace caustics

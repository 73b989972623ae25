#include "experiments/base/atomic_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <set>
#include <string>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "experiments/base/folder_lock.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

namespace fs = std::filesystem;

class WholeFolders : public testing::Test {
protected:
    void write(bool commit = true) const {
        AtomicFolder whole(target_);
        write_atomic_file(whole.path() / "new", "new");
        if (commit) whole.commit();
    }
    std::set<std::string> files_in(const fs::path& folder) const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            names.insert(entry.path().filename());
        return names;
    }
    using Names = std::set<std::string>;
    support::TemporaryFolder folder_;
    fs::path target_ = folder_ / "target";
};

TEST_F(WholeFolders, AreThereOnlyWhenTheyAreWhole) {
    write(false);
    EXPECT_EQ(files_in(folder_.path()), Names());
    write();
    EXPECT_EQ(files_in(folder_.path()), Names{"target"});
    EXPECT_EQ(files_in(target_), Names{"new"});
}

TEST_F(WholeFolders, LeaveOtherFilesWhereTheyAre) {
    write_atomic_file(folder_ / "mine", "mine");
    fs::create_directory(target_);
    fs::rename(folder_ / "mine", target_ / "mine");
    write_atomic_file(target_ / "new", "old");
    write(false);
    EXPECT_EQ(read_whole_file(target_ / "new"), "old");
    write();
    EXPECT_EQ(files_in(target_), (Names{"mine", "new"}));
    EXPECT_EQ(read_whole_file(target_ / "new"), "new");
    EXPECT_EQ(files_in(folder_.path()), Names{"target"});
}

TEST_F(WholeFolders, RemoveWhatAKilledProcessLeft) {
    const pid_t writer = fork();
    if (writer == 0) {
        const AtomicFolder whole(target_);
        write_atomic_file(whole.path() / "half", "");
        std::raise(SIGKILL);
    }
    waitpid(writer, nullptr, 0);
    ASSERT_EQ(files_in(folder_.path()), Names{"target.part"});
    write();
    EXPECT_EQ(files_in(folder_.path()), Names{"target"});
    EXPECT_EQ(files_in(target_), Names{"new"});
}

/// A process that is killed has no time to take back what it has done: at any moment all but an empty
/// folder must be known by its lock.
TEST_F(WholeFolders, KeepTheirLockUntilNothingElseIsLeft) {
    {
        AtomicFolder whole(target_);
        EXPECT_EQ(files_in(whole.path()), Names{".lock"});
        write_atomic_file(whole.path() / "new", "new");
        whole.commit();
    }
    EXPECT_EQ(files_in(target_), Names{"new"});
}

TEST_F(WholeFolders, LeaveNothingWhereTheirLockFindsNoRoom) {
    const pid_t writer = fork();
    if (writer == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit nothing = {0, 0};
        setrlimit(RLIMIT_FSIZE, &nothing);
        try {
            const AtomicFolder whole(target_);
        } catch (const InputError&) {
            _exit(2);
        }
        _exit(0);
    }
    int status = 0;
    waitpid(writer, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 2);
    EXPECT_EQ(files_in(folder_.path()), Names{});
}

TEST_F(WholeFolders, NameALockThatIsNoFile) {
    fs::create_directories(target_ / ".lock");
    try {
        const FolderLock lock(target_);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("/.lock: cannot be written"), std::string::npos)
            << error.what();
    }
}

TEST(FolderLocks, NameAWayOutWhereTheFileSystemHasNone) {
    for (const int error : {ENOLCK, EOPNOTSUPP, ENOSYS, EINVAL}) {
        const std::string told = why_not_locked("there", error);
        EXPECT_TRUE(told.starts_with("there/.lock: cannot be locked (")) << told;
        EXPECT_NE(told.find("write to a folder on a local disk"), std::string::npos) << told;
    }
    EXPECT_EQ(why_not_locked("there", EIO), "there/.lock: cannot be locked (Input/output error)");
}

TEST_F(WholeFolders, AreMissedWhereAnotherTookTheirPath) {
    const FolderLock lock(target_);
    EXPECT_NO_THROW(lock.require_same_folder());
    fs::rename(target_, folder_ / "renamed");
    EXPECT_THROW(lock.require_same_folder(), InputError) << "none is there";
    const FolderLock other(target_);
    try {
        lock.require_same_folder();
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("target: was renamed, removed or made anew"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_NO_THROW(other.require_same_folder());
}

TEST_F(WholeFolders, AreMissedWhereTheirLockWasRemovedAndTheErrorSaysSo) {
    const FolderLock lock(target_);
    fs::remove(target_ / ".lock");
    try {
        lock.require_same_folder();
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(
            std::string(error.what()).find("target/.lock: is not the one that this process holds"),
            std::string::npos)
            << error.what();
    }
}

TEST_F(WholeFolders, TakeBackWhatCannotBePutInPlace) {
    AtomicFolder whole(target_);
    write_atomic_file(whole.path() / "new", "new");
    write_atomic_file(target_, "a file in the way");
    EXPECT_THROW(whole.commit(), std::exception);
    EXPECT_EQ(read_whole_file(target_), "a file in the way");
}

TEST_F(WholeFolders, RemoveNothingElse) {
    fs::create_directory(folder_ / "target.part");
    write_atomic_file(folder_ / "target.part/mine", "mine");
    EXPECT_THROW(write(), InputError);
    EXPECT_EQ(read_whole_file(folder_ / "target.part/mine"), "mine");
}

TEST_F(WholeFolders, AreNotWrittenThroughALinkThatSomebodyLeft) {
    fs::create_directory(folder_ / "other");
    for (const char* name : {"other/.lock", "other/mine"})
        write_atomic_file(folder_ / name, "mine");
    fs::create_directory_symlink(folder_ / "other", folder_ / "target.part");
    EXPECT_THROW(write(), InputError);
    EXPECT_EQ(read_whole_file(folder_ / "other/mine"), "mine");
    EXPECT_EQ(read_whole_file(folder_ / "other/.lock"), "mine");
}

}  // namespace
}  // namespace caustics::experiments

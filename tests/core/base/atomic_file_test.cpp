#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(AtomicFile, IsThereOnlyWhenItIsWhole) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.txt";
    write_atomic_file(file, "old");
    {
        AtomicFile out(file);
        out.write("new ");
        EXPECT_EQ(content(file), "old");
        out.write("text");
        out.commit();
    }
    EXPECT_EQ(content(file), "new text");
    {
        AtomicFile out(file);
        out.write("never finished");
    }
    EXPECT_EQ(content(file), "new text");
    EXPECT_EQ(files_in(folder.path()), 1) << "nothing temporary is left";
}

TEST(AtomicFile, MayHaveTheLongestName) {
    const support::TemporaryFolder folder;
    const std::string longest(255, 'x');
    write_atomic_file(folder / longest, "text");
    EXPECT_EQ(content(folder / longest), "text");
    EXPECT_EQ(files_in(folder.path()), 1);
}

/// Before an hour of rendering rather than after it.
TEST(AtomicFile, WhereItCannotBePutIsFoundBeforeItIsWritten) {
    const support::TemporaryFolder folder;
    const auto why = [](const std::filesystem::path& file) -> std::string {
        try {
            require_writable_place(file);
        } catch (const InputError& error) {
            return error.what();
        }
        return "writable";
    };
    EXPECT_EQ(why(folder / "a.exr"), "writable");
    const std::filesystem::path longer = folder / std::string(256, 'x');
    EXPECT_EQ(why(longer), longer.string() + ": cannot be written (File name too long)");
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    const bool is_root = geteuid() == 0;
    constexpr uid_t nobody = 65534;
    if (is_root) {
        ASSERT_EQ(seteuid(nobody), 0);
    }
    const std::string closed = why(folder / "a.exr");
    if (is_root) {
        ASSERT_EQ(seteuid(0), 0);
    }
    EXPECT_EQ(closed, (folder / "a.exr").string() + ": cannot be written (Permission denied)");
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
}

TEST(AtomicFile, LeavesNothingOfAKilledProcess) {
    const support::TemporaryFolder folder;
    const pid_t writer = fork();
    if (writer == 0) {
        AtomicFile out(folder / "a.txt");
        out.write(std::string(1 << 20, 'x'));
        std::raise(SIGKILL);
    }
    waitpid(writer, nullptr, 0);
    std::FILE* const nameless =
        fdopen(open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0600), "w");
    if (nameless == nullptr) GTEST_SKIP() << "the file system has no files without names";
    std::fclose(nameless);
    EXPECT_EQ(files_in(folder.path()), 0);
}

std::string refusal_to_write(const std::filesystem::path& file, std::string_view bytes) {
    try {
        write_atomic_file(file, bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "written";
}

TEST(AtomicFile, NamesTheFileAndTheReason) {
    const support::TemporaryFolder folder;
    const std::filesystem::path nowhere = folder / "absent" / "a.txt";
    EXPECT_EQ(refusal_to_write(nowhere, "x"),
              nowhere.string() + ": cannot be written (No such file or directory)");
    std::filesystem::create_directories(folder / "a_folder" / "in it");
    const std::string onto_folder = refusal_to_write(folder / "a_folder", "x");
    EXPECT_NE(onto_folder.find("a_folder: cannot be written ("), std::string::npos) << onto_folder;
    EXPECT_EQ(files_in(folder.path()), 1);
}

std::string read_refusal(const std::filesystem::path& file) {
    try {
        read_whole_file(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

TEST(ReadWholeFile, GivesBackEveryByte) {
    const support::TemporaryFolder folder;
    std::string bytes;
    for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i);
    for (const std::string& text : {bytes, std::string()}) {
        write_atomic_file(folder / "a", text);
        EXPECT_EQ(read_whole_file(folder / "a"), text);
    }
}

TEST(ReadWholeFile, RefusesWhatIsNoRegularFileWithoutWaitingForIt) {
    const support::TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(read_refusal(pipe).find("pipe: cannot be read (a pipe or device, not a regular file"),
              std::string::npos);
    EXPECT_NE(read_refusal("/dev/zero").find("not a regular file"), std::string::npos);
    EXPECT_NE(read_refusal(folder.path()).find("a folder"), std::string::npos);
    EXPECT_NE(read_refusal(folder / "absent").find("no such file"), std::string::npos);
}

TEST(AtomicFile, ReplacesNoPipeOrDevice) {
    const support::TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(refusal_to_write(pipe, "x").find("pipe: cannot be written"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    EXPECT_THROW(require_writable_place(pipe), InputError);
    EXPECT_NO_THROW(require_writable_place(folder / "new"));
}

TEST(AtomicFile, IsPutInThePlaceOfNoLinkThatAUserNames) {
    const support::TemporaryFolder folder;
    write_atomic_file(folder / "file", "kept");
    for (const std::string to : {"file", "nowhere"}) {
        std::filesystem::remove(folder / "link");
        std::filesystem::create_symlink(to, folder / "link");
        try {
            require_writable_place(folder / "link");
            ADD_FAILURE() << to;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("link: is a symbolic link"), std::string::npos)
                << error.what();
        }
    }
}

}  // namespace
}  // namespace caustics

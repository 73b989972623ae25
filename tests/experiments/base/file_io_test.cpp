#include "experiments/base/file_io.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

TEST(ReadInput, TakesFilesAndPipesUntilTheyEnd) {
    const support::TemporaryFolder folder;
    const std::string text(200'000, 'x');  // more than a pipe holds
    write_atomic_file(folder / "file", text);
    EXPECT_EQ(read_input(folder / "file"), text);
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] {
        const int out = open(pipe.c_str(), O_WRONLY);
        for (std::size_t done = 0; done < text.size();) {
            const ssize_t count = write(out, text.data() + done, text.size() - done);
            if (count < 0) break;
            done += static_cast<std::size_t>(count);
        }
        close(out);
    });
    EXPECT_EQ(read_input(pipe), text);
    writer.join();
}

std::string refusal(const std::string& file) {
    try {
        read_input(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

TEST(ReadInput, RefusesWhatMayHaveNoEnd) {
    const support::TemporaryFolder folder;
    EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: cannot be read (neither a file nor a pipe)");
    EXPECT_NE(refusal(folder.path()).find("neither a file nor a pipe"), std::string::npos);
    EXPECT_NE(refusal(folder / "absent").find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace caustics::experiments

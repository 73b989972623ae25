#include "experiments/base/signals.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "core/base/interrupt.h"

namespace caustics::experiments {
namespace {

constexpr unsigned too_long = 120;  // seconds, for work that looks at no signal
/// Well beyond the moment at which the process would be ended: on a slow machine these tests pass all the same.
constexpr unsigned beyond = 2;

class Signals : public testing::Test {
protected:
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

[[noreturn]] void work_deafly() {
    for (unsigned left = too_long; left > 0;) left = sleep(left);
    _exit(0);
}

TEST_F(Signals, EndWorkThatLooksAtNone) {
    EXPECT_EXIT(
        {
            catch_interrupts();
            end_soon_after_interrupts();
            std::raise(SIGINT);
            work_deafly();
        },
        testing::ExitedWithCode(130), "^causticbench: error: interrupted\n$");
}

// What has to tidy up takes its time.
TEST_F(Signals, OnlyAskOtherwise) {
    EXPECT_EXIT(
        {
            catch_interrupts();
            std::raise(SIGTERM);
            sleep(beyond);
            _exit(interrupt_requested() ? 7 : 8);
        },
        testing::ExitedWithCode(7), "^$");
}

// A forked child answers to whoever started it.
TEST_F(Signals, LeaveChildrenToTheirParents) {
    EXPECT_EXIT(
        {
            catch_interrupts();
            end_soon_after_interrupts();
            const pid_t child = fork();
            if (child == 0) {
                std::raise(SIGINT);
                sleep(beyond);
                _exit(9);
            }
            int status = 0;
            waitpid(child, &status, 0);
            _exit(WEXITSTATUS(status));
        },
        testing::ExitedWithCode(9), "^$");
}

}  // namespace
}  // namespace caustics::experiments

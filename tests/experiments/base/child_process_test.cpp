#include "experiments/base/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "experiments/base/file_io.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using How = ChildEnd::How;
using Tell = ChildProcess::Tell;

ChildEnd end_of(ChildProcess child) {
    while (!child.has_ended()) wait_for_any({&child});
    return child.end();
}

ChildEnd end_of(const ChildProcess::Work& work, const ChildLimits& limits = {}) {
    return end_of(ChildProcess(work, limits));
}

std::string say(const Tell&) { return "hello"; }

[[noreturn]] std::string hang(const Tell&) {
    while (true) pause();
}

TEST(ChildProcesses, AnswerWithAnyText) {
    const std::string long_text(1 << 20, 's');  // more than a pipe holds, and no share
    EXPECT_EQ(run_in_child([&](const Tell&) { return long_text; }), long_text);
    EXPECT_EQ(run_in_child([](const Tell&) { return std::string(); }), "");
}

TEST(ChildProcesses, ThrowHereWhatTheWorkThrewThere) {
    EXPECT_THROW(run_in_child([](const Tell&) -> std::string { throw InputError("a: b"); }),
                 InputError);
    EXPECT_THROW(run_in_child([](const Tell&) -> std::string { throw UnsupportedScene("c"); }),
                 UnsupportedScene);
    const ChildEnd end = end_of([](const Tell&) -> std::string { throw std::bad_alloc(); });
    EXPECT_EQ(end.how, How::threw);
    EXPECT_EQ(end.text, "out of memory");
}

TEST(ChildProcesses, DoNotHearWhatTheirParentWasAskedBefore) {
    request_interrupt();
    const ChildEnd end = end_of([](const Tell&) -> std::string {
        return interrupt_requested() ? "asked to end" : "not asked";
    });
    forget_interrupt();
    EXPECT_EQ(end.text, "not asked");
}

TEST(ChildProcesses, NeverReturnIntoTheWorkOfTheirParent) {
    const pid_t parent = getpid();
    try {
        const ChildEnd end = end_of([](const Tell&) -> std::string { throw 1; });
        EXPECT_EQ(end.how, How::threw);
        EXPECT_NE(end.text, "");
    } catch (int) {
        if (getpid() != parent) _exit(0);  // without an answer: the parent's test fails
        throw;
    }
}

TEST(ChildProcesses, SurviveTheirCrashes) {
    const ChildEnd fault = end_of([](const Tell&) -> std::string {
        std::signal(SIGSEGV, SIG_DFL);  // sanitizers catch it
        raise(SIGSEGV);
        return "alive";
    });
    EXPECT_EQ(fault.how, How::died);
    EXPECT_NE(fault.text.find("signal 11"), std::string::npos) << fault.text;
    const ChildEnd left = end_of([](const Tell&) -> std::string { _exit(3); });
    EXPECT_EQ(left.how, How::died);
    EXPECT_NE(left.text.find("exit code 3"), std::string::npos) << left.text;
}

TEST(ChildProcesses, EndWhenTheirTimeIsOver) {
    const ChildEnd end = end_of(hang, {.seconds = 0.1, .memory_bytes = 0, .processors = {}});
    EXPECT_EQ(end.how, How::timed_out);
    EXPECT_NE(end.text.find("0.1 s"), std::string::npos) << end.text;
    EXPECT_EQ(end_of(say, {.seconds = 60, .memory_bytes = 0, .processors = {}}).text, "hello");
}

TEST(ChildProcesses, TakeNoMoreMemoryThanAllowed) {
    const auto eat = [](const Tell&) {
        std::vector<std::vector<char>> all;
        while (all.size() < 300) all.emplace_back(1 << 20, 'x');
        pause();
        return std::string();
    };
    const ChildEnd end = end_of(eat, {.seconds = 0, .memory_bytes = 300 << 20, .processors = {}});
    EXPECT_EQ(end.how, How::too_large);
    EXPECT_EQ(end.text, "took more than 300 MiB of memory");
    EXPECT_EQ(end_of(say, {.seconds = 0, .memory_bytes = 300 << 20, .processors = {}}).text,
              "hello");
}

TEST(ChildProcesses, RunWhereTheyAreTold) {
    const int last = own_processors().back();
    const std::string where =
        run_in_child([&](const Tell&) { return std::to_string(own_processors().size()); });
    EXPECT_EQ(where, std::to_string(own_processors().size()));
    const ChildEnd end =
        end_of([](const Tell&) { return std::to_string(own_processors().front()); },
               {.seconds = 0, .memory_bytes = 0, .processors = {last}});
    EXPECT_EQ(end.text, std::to_string(last));
}

TEST(ChildProcesses, PrintIntoTheirLog) {
    const support::TemporaryFolder folder;
    const std::filesystem::path log = folder / "log.txt";
    const auto print = [](const Tell&) {
        std::fputs("to stdout\n", stdout);
        std::fputs("to stderr\n", stderr);
        return std::string("done");
    };
    EXPECT_EQ(end_of(ChildProcess(print, {}, log)).text, "done");
    const std::string text = read_whole_file(log);
    EXPECT_NE(text.find("to stdout\n"), std::string::npos);
    EXPECT_NE(text.find("to stderr\n"), std::string::npos);
    EXPECT_EQ(end_of(ChildProcess(print, {}, folder / "absent/log.txt")).how, How::bad_input);
}

TEST(ChildProcesses, TellHowFarTheyAre) {
    ChildProcess child([](const Tell& tell) {
        tell(0.25);
        pause();
        return std::string();
    });
    while (child.share() != 0.25) {
        ASSERT_FALSE(child.has_ended());
        wait_for_any({&child});
    }
}

TEST(ChildProcesses, DieWithTheirParent) {
    // A parent that is killed while its child hangs; the child's end of `alive` closes with it.
    int alive[2];
    ASSERT_EQ(pipe(alive), 0);
    const pid_t parent = fork();
    if (parent == 0) {
        close(alive[0]);
        ChildProcess child(hang);
        raise(SIGKILL);
    }
    close(alive[1]);
    char none = 0;
    EXPECT_EQ(read(alive[0], &none, 1), 0);
    close(alive[0]);
    waitpid(parent, nullptr, 0);
}

TEST(ChildProcesses, LeaveInterruptsToTheirParent) {
    EXPECT_EQ(run_in_child([](const Tell&) {
                  raise(SIGINT);
                  raise(SIGTERM);
                  return std::string("went on");
              }),
              "went on");
}

TEST(ChildProcesses, AreRefusedAfterAThreadBegan) {
    int wait[2];
    ASSERT_EQ(pipe(wait), 0);
    std::thread thread([&] {
        char none = 0;
        [[maybe_unused]] const ssize_t count = read(wait[0], &none, 1);
    });
    EXPECT_THROW(ChildProcess{say}, std::logic_error);
    close(wait[1]);
    thread.join();
    close(wait[0]);
}

}  // namespace
}  // namespace caustics::experiments

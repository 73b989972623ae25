#include "experiments/base/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <thread>

#include "experiments/base/step_progress.h"
#include "experiments/run/run_progress.h"

namespace caustics::experiments {
namespace {

/// While it lives, stderr is a terminal of so many columns.
class Terminal {
public:
    explicit Terminal(unsigned short columns) : master_(posix_openpt(O_RDWR | O_NOCTTY)) {
        grantpt(master_);
        unlockpt(master_);
        const int end = open(ptsname(master_), O_RDWR | O_NOCTTY);
        const winsize size{24, columns, 0, 0};
        ioctl(end, TIOCSWINSZ, &size);
        std::fflush(stderr);
        dup2(end, STDERR_FILENO);
        close(end);
    }
    ~Terminal() { text(); }
    /// All that was written; stderr is what it was.
    std::string text() {
        if (kept_ < 0) return {};
        std::fflush(stderr);
        // A terminal hands over what was written when the system finds time.
        constexpr int patience = 300;  // [ms]
        std::string all;
        std::array<char, 4096> part;
        pollfd waiting{master_, POLLIN, 0};
        while (poll(&waiting, 1, patience) > 0) {
            const ssize_t count = read(master_, part.data(), part.size());
            if (count <= 0) break;
            all.append(part.data(), static_cast<std::size_t>(count));
        }
        dup2(kept_, STDERR_FILENO);
        close(kept_);
        close(master_);
        kept_ = -1;
        return all;
    }

private:
    int kept_ = dup(STDERR_FILENO);
    int master_;
};

/// The longest stretch of characters between returns and line ends, escape sequences apart.
std::size_t widest_line(const std::string& written) {
    std::size_t widest = 0, width = 0;
    for (std::size_t i = 0; i < written.size(); ++i) {
        if (written.compare(i, 3, "\033[K") == 0)
            i += 2;
        else if (written[i] == '\r' || written[i] == '\n')
            width = 0;
        else if ((static_cast<unsigned char>(written[i]) & 0xC0U) != 0x80U)
            widest = std::max(widest, ++width);
    }
    return widest;
}

class Terminals : public testing::TestWithParam<unsigned short> {};

TEST_P(Terminals, ALineThatIsRepaintedNeverWraps) {
    const std::string name = "ring-beamtree-" + std::string(200, 'x');
    Terminal terminal(GetParam());
    {
        Progress progress(120, 7);
        progress.show(name, 0.25, Eta(3700, true));
        progress.show(name, 0.5, {});
    }
    const std::string written = terminal.text();
    EXPECT_EQ(widest_line(written), GetParam() - 1) << written;
    EXPECT_NE(written.find("[7/120] ETA at least 1:01:40, 25 %"), std::string::npos) << written;
}

INSTANTIATE_TEST_SUITE_P(Progress, Terminals, testing::Values(80, 40, 120));

TEST(Progress, ATextIsCutBetweenCharacters) {
    EXPECT_EQ(first_characters("wärme", 2), "wä");
    EXPECT_EQ(first_characters("wärme", 9), "wärme");
    EXPECT_EQ(first_characters("", 3), "");
}

TEST(Progress, APhaseHasABarAndTheRestOfItsTime) {
    EXPECT_EQ(phase_text("trace", 0.25, Eta(30, true)),
              "trace [#####...............] 25 %, ETA at least 0:30");
    EXPECT_EQ(phase_text("tree", 0, {}), "tree [....................] 0 %, ETA -");
    EXPECT_EQ(phase_text("render", 1, Eta(0)), "render [####################] 100 %, ETA 0:00");
}

TEST(RunEta, IsThatOfTheWholeRunOnceItRenders) {
    RunEta eta(1);
    eta.begin("precompute", 0);
    eta.begin("trace", 1);
    EXPECT_FALSE(eta.at(0, 2));
    EXPECT_TRUE(eta.at(0.5, 4)->at_least);
    EXPECT_DOUBLE_EQ(eta.at(0.5, 4)->seconds, 3);
    eta.begin("render", 7);
    EXPECT_FALSE(eta.at(0, 7));
    EXPECT_FALSE(eta.at(0.25, 9)->at_least);
    EXPECT_DOUBLE_EQ(eta.at(0.25, 9)->seconds, 6);
}

TEST(RunEta, CountsTheLaterPassesByWhatTheFirstOnesTook) {
    // Four passes, each 2 s of build and 3 s of render.
    RunEta eta(4);
    double now = 0;
    for (int pass = 0; pass < 4; ++pass) {
        const double whole = 20 - 5 * pass;
        eta.begin("trace", now);
        EXPECT_EQ(eta.pass(), pass + 1);
        if (pass > 0) {
            EXPECT_NEAR(eta.at(0.5, now + 1)->seconds, whole - 1, 1e-9);
            EXPECT_FALSE(eta.at(0.5, now + 1)->at_least);
        }
        eta.begin("render", now + 2);
        EXPECT_EQ(eta.pass(), pass + 1);
        EXPECT_NEAR(eta.at((pass + 0.5) / 4, now + 3.5)->seconds, whole - 3.5, 1e-9);
        now += 5;
    }
}

TEST(Progress, ARunShowsItsPhasesOnATerminalAndLeavesNothingThere) {
    Terminal terminal(80);
    {
        RunOptions options;
        const RunProgress progress(options);
        options.phase("trace");
        options.phase("render");
    }
    const std::string written = terminal.text();
    EXPECT_NE(written.find("trace ..."), std::string::npos) << written;
    EXPECT_LT(written.find("trace ..."), written.find("render ...")) << written;
    EXPECT_EQ(written.substr(written.size() - 4), "\r\033[K");
}

TEST(Progress, AnyThreadMayTellTheShareOfARun) {
    Terminal terminal(80);
    {
        RunOptions options;
        const RunProgress progress(options);
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                for (int share = 0; share < 1000; ++share) options.report(share / 1000.0);
            });
    }
    EXPECT_LT(widest_line(terminal.text()), 80U);
}

TEST(StepProgress, WhatLaterStepsTakeIsInTheEta) {
    Terminal terminal(80);
    {
        StepProgress steps(3);
        steps.expect_later(Eta(100, true));
        steps.begin("one", 20);
        steps.expect_later(Eta(100));
        steps.end("done");
    }
    const std::string written = terminal.text();
    EXPECT_NE(written.find("[0/3] ETA at least "), std::string::npos) << written;
    EXPECT_NE(written.find(", 0 % one"), std::string::npos) << written;
    EXPECT_NE(written.find("[1/3] one: done, ETA 1:40"), std::string::npos) << written;
}

}  // namespace
}  // namespace caustics::experiments

#include "experiments/base/progress.h"

#include <gtest/gtest.h>

#include <thread>

#include "experiments/base/step_progress.h"
#include "experiments/run/run_progress.h"
#include "tests/experiments/terminal.h"

namespace caustics::experiments {
namespace {

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

TEST(RunEta, GoesByThePlanFromTheStart) {
    RunEta eta(1, {{"plan", 1}, {"trace", 3}, {"render", 6}});
    eta.begin("plan", 0);
    EXPECT_DOUBLE_EQ(eta.done(0), 0);
    EXPECT_DOUBLE_EQ(eta.at(0, 0)->seconds, 10);
    eta.begin("trace", 1);
    EXPECT_DOUBLE_EQ(eta.done(0), 0.1);
    // Twice as slow as foretold so far.
    EXPECT_DOUBLE_EQ(eta.at(1.0 / 3, 4)->seconds, 16);
    EXPECT_FALSE(eta.at(1.0 / 3, 4)->at_least);
    eta.begin("render", 8);
    EXPECT_DOUBLE_EQ(eta.done(0.5), 0.7);
    EXPECT_DOUBLE_EQ(eta.done(1), 1);
}

TEST(RunEta, DoneNeverFalls) {
    for (const int passes : {1, 3}) {
        RunEta eta(passes);
        double last = 0;
        for (int pass = 0; pass < passes; ++pass) {
            for (const char* phase : {"trace", "balance", "render"}) {
                eta.begin(phase, 0);
                for (const double share : {0.0, 0.5, 0.2, 1.0}) {
                    const bool renders = std::string(phase) == "render";
                    const double done = eta.done(renders ? (pass + share) / passes : share);
                    EXPECT_GE(done, last);
                    EXPECT_LE(done, 1);
                    last = done;
                }
            }
        }
        EXPECT_DOUBLE_EQ(last, 1);
    }
}

TEST(RunEta, CountsAPassOnceWhoseRenderingHasSeveralStretches) {
    RunEta eta(2);
    eta.begin("trace", 0);
    eta.begin("render", 2);
    eta.begin("render", 4);
    EXPECT_EQ(eta.pass(), 1);
    // 3 s of rendering were half of it, and the second pass builds for 2 s.
    EXPECT_DOUBLE_EQ(eta.at(0.5, 5)->seconds, 3 + 2);
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

TEST(Progress, ARunOfSeveralPassesNamesTheOneAtWork) {
    Terminal terminal(80);
    {
        RunOptions options;
        const RunProgress progress(options, 2);
        for (const char* phase : {"trace", "render", "balance"}) options.phase(phase);
    }
    const std::string written = terminal.text();
    for (const char* shown : {"1/2 trace ...", "1/2 render ...", "2/2 balance ..."})
        EXPECT_NE(written.find(shown), std::string::npos) << written;
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

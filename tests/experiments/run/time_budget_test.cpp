#include "experiments/run/time_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace caustics::experiments {
namespace {

using SecondsOf = std::function<double(double work)>;

struct Outcome {
    std::int64_t work = 0;
    double seconds = 0;    ///< that it takes
    double in_trials = 0;  ///< all of them, the last one included
    int trials = 0;
};

Outcome search(double seconds, const WorkParameter& work, const SecondsOf& cost) {
    TimeBudget budget(seconds, work);
    Outcome outcome;
    bool goes_on = true;
    while (goes_on) {
        outcome.work = budget.work();
        outcome.seconds = cost(static_cast<double>(outcome.work));
        outcome.in_trials += outcome.seconds;
        ++outcome.trials;
        goes_on = budget.goes_on_after(outcome.seconds);
    }
    return outcome;
}

const WorkParameter photons{.parameter = "photons", .first = 1000, .most = 1'000'000'000};
const WorkParameter mesh{.parameter = "mesh_resolution", .power = 2, .first = 8, .most = 4096};

TEST(TimeBudget, FillsTheTimeWhateverItsConstantIs) {
    for (const double constant : {0.0, 0.01, 0.3})
        for (const double seconds : {1.0, 10.0, 1000.0}) {
            const Outcome outcome =
                search(seconds, photons, [=](double n) { return constant + 3e-6 * n; });
            EXPECT_NEAR(outcome.seconds, seconds, TimeBudget::tolerance * seconds) << constant;
            EXPECT_LT(outcome.in_trials, 2.5 * seconds + 4 * constant) << constant;
            EXPECT_LE(outcome.trials, 12) << constant;
        }
}

TEST(TimeBudget, FollowsWorkThatGrowsInSquares) {
    for (const double constant : {0.0, 0.2})
        for (const double seconds : {1.0, 30.0}) {
            const Outcome outcome =
                search(seconds, mesh, [=](double n) { return constant + 2e-5 * n * n; });
            EXPECT_NEAR(outcome.seconds, seconds, TimeBudget::tolerance * seconds) << constant;
        }
}

TEST(TimeBudget, ComesNearWhereTimeGrowsFasterThanForetold) {
    const Outcome outcome = search(5, photons, [](double n) { return 1e-8 * std::pow(n, 1.4); });
    EXPECT_NEAR(outcome.seconds, 5, 0.25 * 5);
    EXPECT_LT(outcome.in_trials, 5 * 5.0);
}

TEST(TimeBudget, EndsAtTheLeastWhichIsTooLong) {
    const Outcome outcome = search(1, mesh, [](double n) { return 9 + n; });
    EXPECT_EQ(outcome.work, mesh.first);
    EXPECT_EQ(outcome.trials, 1);
}

TEST(TimeBudget, EndsAtTheMost) {
    const Outcome outcome = search(1e6, mesh, [](double n) { return 1e-7 * n * n; });
    EXPECT_EQ(outcome.work, mesh.most);
}

TEST(TimeBudget, EndsWhereTimeIsChance) {
    int calls = 0;
    const Outcome outcome =
        search(1, photons, [&](double) { return ++calls % 2 == 0 ? 0.2 : 3.0; });
    EXPECT_LE(outcome.trials, 12);
}

}  // namespace
}  // namespace caustics::experiments

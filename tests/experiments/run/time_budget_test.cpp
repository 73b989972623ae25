#include "experiments/run/time_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace caustics::experiments {
namespace {

using Work = TimeBudget::Work;
/// The cost of a picture by its work and the share of its pixels.
using CostOf = std::function<TimeBudget::Cost(double work, double pixels)>;

struct Outcome {
    TimeBudget::Plan plan;  ///< of the last picture
    double used = 0;        ///< by all pictures and by loading [s]
    double in_trials = 0;   ///< [s]
    int trials = 0;
    double least = 0;
};

struct Search {
    WorkParameter work;
    int pixel_step = 1;
    double loading = 0;  ///< [s]
    Work kind = Work::of_pixels;
};

Outcome spend(double seconds, const Search& search, const CostOf& cost_of) {
    TimeBudget budget(search.work, search.kind, search.pixel_step);
    Outcome outcome;
    const auto make = [&] {
        outcome.plan = budget.plan();
        const TimeBudget::Cost cost = cost_of(static_cast<double>(outcome.plan.work),
                                              outcome.plan.is_last ? 1.0 : 1.0 / search.pixel_step);
        outcome.in_trials = outcome.used;
        outcome.used += cost.build + cost.render;
        return cost;
    };
    while (!budget.plan().is_last && outcome.trials < 100) {
        const TimeBudget::Cost cost = make();
        ++outcome.trials;
        budget.take(cost, seconds - search.loading - outcome.used);
    }
    outcome.least = budget.least();
    make();
    outcome.used += search.loading;
    return outcome;
}

const WorkParameter photons{.parameter = "photons", .first = 1000, .most = 1'000'000'000};
const WorkParameter mesh{.parameter = "mesh_resolution", .power = 2, .first = 8, .most = 4096};

TEST(TimeBudget, FillsWhatIsLeftWhateverItsConstantsAre) {
    for (const int step : {1, 4, 16})
        for (const double seconds : {3.0, 10.0, 1000.0})
            for (const double loading : {0.0, 0.3 * seconds}) {
                const Outcome outcome =
                    spend(seconds, {photons, step, loading}, [](double n, double pixels) {
                        return TimeBudget::Cost{0.02 + 3e-6 * n, pixels * (0.2 + 1e-7 * n)};
                    });
                EXPECT_TRUE(outcome.plan.is_last);
                EXPECT_NEAR(outcome.used, seconds, 0.02 * seconds) << step << " " << loading;
                EXPECT_LE(outcome.trials, 8) << seconds;
            }
}

// Trials leave less time to the picture.
TEST(TimeBudget, SpendsLittleOnTrialsWhereTheyAreOfFewPixels) {
    for (const double seconds : {4.0, 100.0}) {
        const Outcome outcome = spend(seconds, {photons, 16}, [](double n, double pixels) {
            return TimeBudget::Cost{0.02 + 3e-6 * n, pixels * (0.2 + 1e-6 * n)};
        });
        EXPECT_LT(outcome.in_trials, 0.4 * seconds);
    }
}

TEST(TimeBudget, FollowsWorkThatGrowsInSquares) {
    for (const double constant : {0.0, 0.05})
        for (const double seconds : {1.0, 30.0}) {
            const Outcome outcome = spend(seconds, {mesh}, [=](double n, double) {
                return TimeBudget::Cost{constant + 2e-5 * n * n, 0.01};
            });
            EXPECT_NEAR(outcome.used, seconds, TimeBudget::tolerance * seconds) << constant;
        }
}

// Light paths that connect to the camera cost the same for any number of pixels.
TEST(TimeBudget, CountsThePathsOfAPictureOnce) {
    const Outcome outcome =
        spend(20, {photons, 16, 0, Work::of_picture},
              [](double n, double pixels) { return TimeBudget::Cost{0, 1e-6 * n + 2 * pixels}; });
    EXPECT_NEAR(outcome.used, 20, 0.05 * 20);
}

// Very few photons cost less than a line through larger numbers foretells.
TEST(TimeBudget, DoesNotTrustTheFirstTwoTrials) {
    const Outcome outcome = spend(2, {photons}, [](double n, double) {
        return TimeBudget::Cost{0, (n < 5000 ? 0.09 : 0.22) + 1e-6 * n};
    });
    EXPECT_NEAR(outcome.used, 2, TimeBudget::tolerance * 2);
}

TEST(TimeBudget, ComesNearWhereTimeGrowsFasterThanForetold) {
    const Outcome outcome = spend(5, {photons, 16}, [](double n, double pixels) {
        return TimeBudget::Cost{5e-8 * n * std::log(n), pixels * (0.3 + 2e-7 * n)};
    });
    EXPECT_NEAR(outcome.used, 5, TimeBudget::tolerance * 5);
}

TEST(TimeBudget, EndsAtTheLeastWhichIsTooLong) {
    const Outcome outcome = spend(
        1, {mesh, 4}, [](double n, double pixels) { return TimeBudget::Cost{9 + n, 4 * pixels}; });
    EXPECT_EQ(outcome.plan.work, mesh.first);
    EXPECT_EQ(outcome.trials, 1);
    EXPECT_NEAR(outcome.least, 9 + 8 + 4, 1e-9);
}

// Trials leave room for the least picture, and what they do not tell is not spent.
TEST(TimeBudget, StaysWithinATimeThatIsHardlyEnough) {
    for (const double seconds : {2.2, 3.0, 4.0, 6.0}) {
        const Outcome outcome = spend(seconds, {photons, 4}, [](double n, double pixels) {
            return TimeBudget::Cost{1 + 1e-6 * n, 0.08 * pixels};
        });
        EXPECT_LT(outcome.used, 1.05 * seconds);
    }
}

TEST(TimeBudget, EndsAtTheMost) {
    const Outcome outcome =
        spend(1e6, {mesh}, [](double n, double) { return TimeBudget::Cost{1e-7 * n * n, 1e-3}; });
    EXPECT_EQ(outcome.plan.work, mesh.most);
    EXPECT_LE(outcome.trials, 8);
}

TEST(TimeBudget, EndsWhereTimeIsChance) {
    int calls = 0;
    const Outcome outcome = spend(10, {photons}, [&](double, double) {
        return TimeBudget::Cost{++calls % 2 == 0 ? 0.02 : 0.3, 0.01};
    });
    EXPECT_TRUE(outcome.plan.is_last);
    EXPECT_LE(outcome.trials, 20);  // each of the ten seconds has room for a few of these trials
}

}  // namespace
}  // namespace caustics::experiments

#include "experiments/sweep/sweep_warnings.h"

#include <gtest/gtest.h>

namespace caustics::experiments {
namespace {

using Lines = std::vector<std::string>;

/// Of one trial, where `reference` is what judges it.
Lines warnings(const std::string& method, std::uint64_t seed, const std::string& reference,
               std::uint64_t reference_seed) {
    SweepPlan plan;
    Trial& trial = plan.trials.emplace_back();
    trial.request.method.name = method;
    trial.request.seed = seed;
    trial.reference.emplace();
    trial.reference->request.method.name = reference;
    trial.reference->request.seed = reference_seed;
    return sweep_warnings(plan, SweepOptions(), SweepStatus(), 0);
}

TEST(SweepWarnings, TellOfTrialsThatShareLightPathsWithTheirReference) {
    const Lines lines = warnings("lighttrace", 7, "lighttrace", 7);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("warning: trials of lighttrace with seed 7 share light paths"))
        << lines[0];
    EXPECT_EQ(warnings("lighttrace", 8, "lighttrace", 7), Lines()) << "another seed";
    EXPECT_EQ(warnings("pathtrace", 7, "lighttrace", 7), Lines()) << "another method";
    EXPECT_EQ(warnings("none", 7, "none", 7), Lines()) << "no paths";
}

TEST(SweepWarnings, TellNothingOfTrialsWithoutAReference) {
    SweepPlan plan;
    plan.trials.emplace_back().request.method.name = "lighttrace";
    EXPECT_EQ(sweep_warnings(plan, SweepOptions(), SweepStatus(), 0), Lines());
}

}  // namespace
}  // namespace caustics::experiments

#include "experiments/sweep/sweep_warnings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "experiments/base/child_process.h"
#include "experiments/plan/plan_file.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using Lines = std::vector<std::string>;

/// Of one trial, where `reference` is what judges it.
SweepPlan judged(const std::string& method, std::uint64_t seed, const std::string& reference,
                 std::uint64_t reference_seed) {
    SweepPlan plan;
    Trial& trial = plan.trials.emplace_back();
    trial.request.method.name = method;
    trial.request.seed = seed;
    trial.reference.emplace();
    trial.reference->request.method.name = reference;
    trial.reference->request.seed = reference_seed;
    return plan;
}

Lines warnings_on(const SweepPlan& plan) {
    return sweep_warnings(plan, SweepOptions(), SweepStatus(), 0);
}

Lines warnings(const std::string& method, std::uint64_t seed, const std::string& reference,
               std::uint64_t reference_seed) {
    return warnings_on(judged(method, seed, reference, reference_seed));
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

TEST(SweepWarnings, TellOfIndirectLightThatSharesPathsWithItsReference) {
    const auto with_indirect = [](const char* own, const char* reference) {
        SweepPlan plan = judged("photonmap", 7, "lighttrace", 7);
        Trial& trial = plan.trials[0];
        if (*own != 0) trial.request.indirect = IndirectMethod{own};
        if (*reference != 0) trial.reference->request.indirect = IndirectMethod{reference};
        return warnings_on(plan);
    };
    const Lines lines = with_indirect("pathtrace", "pathtrace");
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("warning: trials of pathtrace with seed 7 share light paths"))
        << lines[0];
    EXPECT_EQ(with_indirect("globalphotonmap", "pathtrace"), Lines());
    EXPECT_EQ(with_indirect("pathtrace", ""), Lines());
    EXPECT_EQ(with_indirect("", "pathtrace"), Lines());
}

TEST(SweepWarnings, TellNothingOfTrialsWithoutAReference) {
    SweepPlan plan;
    plan.trials.emplace_back().request.method.name = "lighttrace";
    EXPECT_EQ(warnings_on(plan), Lines());
}

TEST(SweepWarnings, TellOfTrialsOfOtherSweepsAndHowToHaveOneTable) {
    const support::TemporaryFolder folder;
    SweepOptions options;
    options.folder = folder.path();
    SweepPlan plan;
    plan.files = {"/a.json", "/b.json"};
    const auto line = [&] {
        const Lines lines = sweep_warnings(plan, options, SweepStatus(), 3);
        return lines.size() == 1 ? lines[0] : fmt::format("{} lines", lines.size());
    };
    const std::string alone = "warning: " + folder.path().string() +
                              " holds 3 trials that /a.json /b.json does not name, by other sweeps "
                              "or by other scenes: records.csv leaves them out";
    EXPECT_EQ(line(), alone) << "without a plan";
    write_plan(plan_file(plan), folder.path());
    EXPECT_EQ(line(), alone) << "the same sweeps of other scenes";
    SweepPlan earlier;
    earlier.files = {"/c.json", "/d.json"};
    write_plan(plan_file(earlier), folder.path());
    EXPECT_EQ(line(), alone + " (the plan before was of /c.json /d.json; name both for one table)");
}

TEST(SweepWarnings, TellOfOtherCodeAndTimesUnlessAllRunsAgain) {
    Trial trial;
    SweepStatus status;
    status.todo = {&trial};
    status.other_code["0.1 (old)"] = 2;
    status.isas = {"another"};
    SweepOptions options;
    const Lines lines = sweep_warnings({}, options, status, 0);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_TRUE(lines[0].starts_with("warning: results by other code than this program's, "))
        << lines[0];
    EXPECT_NE(lines[0].find(": 2 by 0.1 (old) ("), std::string::npos) << lines[0];
    EXPECT_TRUE(lines[1].starts_with("warning: trials of another and ")) << lines[1];
    options.force = true;
    EXPECT_EQ(sweep_warnings({}, options, status, 0), Lines());
}

TEST(SweepWarnings, TellOfTrialsThatAreNamedTwice) {
    SweepPlan plan;
    plan.duplicates = 4;
    EXPECT_EQ(warnings_on(plan),
              Lines{"note: the sweep names 4 trials more than once; each is run once"});
}

TEST(SweepWarnings, TellOfTrialsThatFailedUnlessTheyRunAgain) {
    std::vector<Trial> trials(3);
    SweepStatus status;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        trials[i].id = std::string(1, "abc"[i]);
        status.share.push_back(&trials[i]);
    }
    status.statuses = {{"a", "failed"}, {"b", "timeout"}, {"c", "done"}};
    SweepOptions options;
    EXPECT_EQ(sweep_warnings({}, options, status, 0),
              Lines{"note: 2 trials failed or took too long before (--rerun failed runs them "
                    "again)"});
    options.rerun_failed = true;
    EXPECT_EQ(sweep_warnings({}, options, status, 0), Lines());
    options = {};
    options.force = true;
    EXPECT_EQ(sweep_warnings({}, options, status, 0), Lines());
}

TEST(SweepWarnings, TellOfMoreThreadsThanProcessors) {
    const std::size_t processors = own_processors().size();
    Trial trial;
    SweepStatus status;
    status.todo = {&trial};
    SweepOptions options;
    options.trials.threads = static_cast<int>(processors);
    EXPECT_EQ(sweep_warnings({}, options, status, 0), Lines()) << "one trial has all";
    options.trials.jobs = 2;
    EXPECT_EQ(sweep_warnings({}, options, status, 0),
              Lines{fmt::format("warning: 2 trials at a time share {} processors: their times are "
                                "no measurement",
                                processors)});
    status.todo.clear();
    EXPECT_EQ(sweep_warnings({}, options, status, 0), Lines()) << "none runs";
}

}  // namespace
}  // namespace caustics::experiments

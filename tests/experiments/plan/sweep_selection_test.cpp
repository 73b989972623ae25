#include "experiments/plan/sweep_selection.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "core/base/error.h"
#include "core/base/hash.h"

namespace caustics::experiments {
namespace {

/// methods × photons × seeds × repeats, in that order.
SweepPlan some_plan() {
    SweepPlan plan;
    for (const char* method : {"photonmap", "beamtree"})
        for (const char* photons : {"10", "100000"})
            for (std::uint64_t seed = 1; seed <= 5; ++seed)
                for (int repeat = 1; repeat <= 3; ++repeat) {
                    Trial trial;
                    trial.scene_name = "pool";
                    trial.request.method.name = method;
                    trial.request.seed = seed;
                    trial.repeat = repeat;
                    trial.swept = {
                        {"photons", photons}, {"mode", "\"split\""}, {"tint", "[0.1,0.2]"}};
                    trial.id = fmt::format("{}-{}-{}-{}", method, photons, seed, repeat);
                    trial.config_hash = hex(fnv1a(trial.id));
                    plan.trials.push_back(trial);
                }
    return plan;
}

std::string error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::size_t chosen(const std::vector<std::string>& filters) {
    SweepPlan plan = some_plan();
    choose(plan, filters);
    return run_order(plan).size();
}

TEST(Filters, ChooseWhatFitsAllKeysAndOneOfAKeysValues) {
    EXPECT_EQ(chosen({}), 60U);
    EXPECT_EQ(chosen({"method=beamtree"}), 30U);
    EXPECT_EQ(chosen({"method=beamtree", "seed=1", "seed=2"}), 12U);
    EXPECT_EQ(chosen({"photons=1e5", "repeat=3"}), 10U) << "numbers by value";
    EXPECT_EQ(chosen({"photons=100k", "repeat=3"}), 10U);
    EXPECT_EQ(chosen({"mode=split"}), 60U);
    EXPECT_EQ(chosen({"tint=[0.1, 0.2]"}), 60U);
    EXPECT_EQ(chosen({"trial=beamtree-10-1-1"}), 1U);
}

// 4k and 1k are names where the plan has them, and numbers otherwise.
TEST(Filters, TakeATextAsItIsBeforeTheyTakeItForANumber) {
    SweepPlan plan = some_plan();
    plan.trials[20].scene_name = "1e3";
    for (std::size_t i = 0; i < 10; ++i) {
        plan.trials[i].scene_name = "4k";
        plan.trials[i].swept.emplace_back("film", i < 4 ? "\"1k\"" : "\"2k\"");
    }
    const auto count = [&](const std::vector<std::string>& filters) {
        choose(plan, filters);
        return run_order(plan).size();
    };
    EXPECT_EQ(count({"scene=4k"}), 10U);
    EXPECT_EQ(count({"scene=1e3"}), 1U);
    EXPECT_EQ(count({"film=1k"}), 4U);
    EXPECT_EQ(count({"film=1k", "film=2k"}), 10U);
    EXPECT_EQ(count({"film=2k", "scene=4k", "photons=0.01k"}), 6U);
    EXPECT_NE(error_of([&] { count({"film=3k"}); }).find("no trial has that value"),
              std::string::npos);
}

TEST(Filters, RefuseWhatNoTrialHas) {
    EXPECT_NE(error_of([] {
                  chosen({"methd=beamtree"});
              }).find("did you mean method? (known: method, mode, photons"),
              std::string::npos);
    EXPECT_NE(error_of([] { chosen({"photons=11"}); }).find("known: 10, 100000"),
              std::string::npos);
    EXPECT_NE(error_of([] { chosen({"beamtree"}); }).find("expected key=value"), std::string::npos);
    EXPECT_NE(error_of([] { chosen({"trial=beamtree-10-1-1", "seed=2"}); }).find("no trial fits"),
              std::string::npos);
}

TEST(Shards, ShareThePlanOutEachTrialOnce) {
    const SweepPlan plan = some_plan();
    const std::vector<const Trial*> all = run_order(plan);
    for (int count = 1; count <= 70; count += 3) {
        std::multiset<const Trial*> together;
        for (int index = 1; index <= count; ++index) {
            const auto part = shard_of(all, {index, count});
            EXPECT_LE(part.size(), (all.size() + static_cast<std::size_t>(count) - 1) /
                                       static_cast<std::size_t>(count));
            together.insert(part.begin(), part.end());
        }
        EXPECT_EQ(together, std::multiset<const Trial*>(all.begin(), all.end())) << count;
    }
}

TEST(Shards, AreReadStrictly) {
    const Shard shard = parse_shard("2/5");
    EXPECT_EQ(shard.index, 2);
    EXPECT_EQ(shard.count, 5);
    for (const char* text : {"", "2", "0/5", "6/5", "-1/5", "1/0", "1/5x", "a/b", "1/"})
        EXPECT_THROW(parse_shard(text), InputError) << text;
}

void set_array(const char* id, const char* first, const char* last, const char* count) {
    setenv("SLURM_ARRAY_TASK_ID", id, 1);
    setenv("SLURM_ARRAY_TASK_MIN", first, 1);
    setenv("SLURM_ARRAY_TASK_MAX", last, 1);
    setenv("SLURM_ARRAY_TASK_COUNT", count, 1);
}

TEST(Shards, ComeFromTheTaskOfASlurmArray) {
    unsetenv("SLURM_ARRAY_TASK_ID");
    EXPECT_NE(error_of([] { parse_shard("auto"); }).find("SLURM_ARRAY_TASK_ID is not set"),
              std::string::npos);
    set_array("3", "1", "8", "8");
    EXPECT_EQ(parse_shard("auto").index, 3);
    EXPECT_EQ(parse_shard("auto").count, 8);
    set_array("0", "0", "7", "8");
    EXPECT_EQ(parse_shard("auto").index, 1);
    set_array("5", "5", "5", "1");  // one task submitted again would run all of the plan
    EXPECT_THROW(parse_shard("auto"), InputError);
    set_array("1", "1", "9", "5");  // 1-9:2
    EXPECT_THROW(parse_shard("auto"), InputError);
}

TEST(RunOrder, TakesRepeatsOneAfterTheOtherAndMixesMethods) {
    const SweepPlan plan = some_plan();
    const std::vector<const Trial*> order = run_order(plan);
    ASSERT_EQ(order.size(), plan.trials.size());
    EXPECT_TRUE(
        std::ranges::is_sorted(order, {}, [](const Trial* trial) { return trial->repeat; }));
    // In the plan a repeat's 20 trials change their method once; at random, 19 * 20 / 38 = 10 times
    // with a standard deviation of 2.2.
    for (std::size_t repeat = 0; repeat < 3; ++repeat) {
        int changes = 0;
        for (std::size_t i = 20 * repeat + 1; i < 20 * (repeat + 1); ++i)
            changes += order[i]->request.method.name != order[i - 1]->request.method.name ? 1 : 0;
        EXPECT_GE(changes, 4) << repeat;
    }
    SweepPlan reversed = plan;
    std::ranges::reverse(reversed.trials);
    const std::vector<const Trial*> again = run_order(reversed);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i]->id, again[i]->id);
}

}  // namespace
}  // namespace caustics::experiments

#include "experiments/sweep/cost_estimate.h"

#include <gtest/gtest.h>

namespace caustics::experiments {
namespace {

Trial trial(const std::string& cell, const std::string& method, const std::string& scene) {
    Trial trial;
    trial.cell = cell;
    trial.request.method.name = method;
    trial.scene_name = scene;
    return trial;
}

TEST(CostEstimates, AskTheClosestThatRan) {
    CostEstimate costs;
    const Trial cell = trial("1", "photonmap", "pool");
    const Trial scene = trial("2", "photonmap", "pool");
    const Trial method = trial("3", "photonmap", "ring");
    const Trial other = trial("4", "beamtree", "ring");
    EXPECT_FALSE(costs.of(cell));
    costs.add(other, {10, 1000});
    EXPECT_EQ(costs.of(cell)->seconds, 10);
    costs.add(method, {2, 100});
    EXPECT_EQ(costs.of(cell)->seconds, 2);
    costs.add(scene, {4, 200});
    EXPECT_EQ(costs.of(cell)->seconds, 4);
    costs.add(cell, {1, 50});
    costs.add(cell, {3, 70});
    EXPECT_EQ(costs.of(cell)->seconds, 2) << "the mean";
    EXPECT_EQ(costs.of(cell)->bytes, 60);
    EXPECT_EQ(costs.of(scene)->seconds, 4);
    EXPECT_EQ(costs.of(trial("5", "none", "ball"))->seconds, (10.0 + 2 + 4 + 1 + 3) / 5);
}

Trial of_photons(int photons) {
    Trial one = trial(std::to_string(photons), "photonmap", "pool");
    one.request.method =
        parse_method("photonmap", parameters_node({"photons=" + std::to_string(photons)}));
    return one;
}

TEST(CostEstimates, FollowTheWorkOfAMethod) {
    CostEstimate costs;
    costs.add(of_photons(1'000), {0.25, 100});
    EXPECT_EQ(costs.of(of_photons(1'000'000))->seconds, 0.25) << "one work tells nothing of others";
    costs.add(of_photons(11'000), {0.5, 300});
    EXPECT_NEAR(costs.of(of_photons(101'000))->seconds, 2.75, 1e-9);
    EXPECT_EQ(costs.of(of_photons(101'000))->bytes, 200);
    EXPECT_EQ(costs.of(of_photons(11'000))->seconds, 0.5) << "of its own cell";
    EXPECT_EQ(costs.of(trial("beams", "beamtree", "pool"))->seconds, 0.375);
    Trial of_emitted = trial("emitted", "photonmap", "pool");
    of_emitted.request.method = parse_method("photonmap", parameters_node({"emitted=101000"}));
    EXPECT_EQ(costs.of(of_emitted)->seconds, 0.375) << "its photons are not known";
    Trial elsewhere = of_photons(101'000);
    elsewhere.scene_name = "ring";
    EXPECT_EQ(costs.of(elsewhere)->seconds, 0.375);
}

TEST(CostEstimates, DoNotFallBelowWhatRan) {
    CostEstimate costs;
    costs.add(of_photons(1'000), {0.5, 0});
    costs.add(of_photons(2'000), {0.25, 0});
    EXPECT_EQ(costs.of(of_photons(1'000'000))->seconds, 0.375) << "more took no longer";
    CostEstimate steep;
    steep.add(of_photons(1'000), {0.0625, 0});
    steep.add(of_photons(2'000), {0.25, 0});
    EXPECT_GT(steep.of(of_photons(10))->seconds, 0) << "not by a start below 0";
}

}  // namespace
}  // namespace caustics::experiments

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

}  // namespace
}  // namespace caustics::experiments

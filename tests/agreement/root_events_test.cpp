#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "tests/support/ball_before_mirror.h"

namespace caustics {
namespace {

// Irradiance at places of the floor where light arrives after three events.
std::vector<double> irradiances(int mesh_resolution, int root_events) {
    const Scene scene(support::ball_before_mirror());
    beamtree::BeamTreeParams params;
    params.max_bounces = 3;
    params.prune = 0;
    params.mesh_resolution = mesh_resolution;
    params.root_events = root_events;
    const auto method = beamtree::build(scene, params, RunOptions{});
    std::vector<ReceiverPoint> points;
    for (int i = -2; i <= 2; ++i)
        for (int j = -2; j <= 2; ++j)
            points.push_back(
                support::probe(scene, 0, {-1.475 + 0.1 * i, 0.1 * j, -3}, Vec3d::UnitZ(), 0));
    std::vector<double> found;
    for (const Estimate& each : support::irradiance(*method, points))
        found.push_back(static_cast<double>(each.value.mean()));
    return found;
}

double largest_difference(const std::vector<double>& some, const std::vector<double>& truth) {
    double largest = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        largest = std::max(largest, std::abs(some[i] / truth[i] - 1));
    return largest;
}

// Rays that are found do not depend on the polygons, whose images are far too large here.
TEST(RootEvents, GiveLightOfMoreEventsItsPlace) {
    const std::vector<double> truth = irradiances(64, 3);
    EXPECT_LE(largest_difference(irradiances(12, 3), truth), 1e-3);
    EXPECT_GE(largest_difference(irradiances(12, 2), truth), 0.05);
}

}  // namespace
}  // namespace caustics

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/reference/light_trace.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

constexpr double water_index = 1.333;
constexpr double radius = 0.2;

// Parallel light falls aslant through still water onto a floor and a wall that meet at x = 0: both are
// lit evenly, the wall by tan(angle in the water) of what the floor gets.
struct Corner {
    SceneDesc desc;
    double floor = 0;  ///< irradiance
    double wall = 0;
};

Corner corner() {
    const double angle = pi_d / 6;
    const double in_water = std::asin(std::sin(angle) / water_index);
    Corner corner;
    corner.desc.shapes = {
        support::horizontal("water", 2, 4, true, support::glass(static_cast<float>(water_index))),
        support::rectangle("floor", {2, 0, 0}, {2, 0, 0}, {0, 2, 0}, support::diffuse(0.5F)),
        support::rectangle("wall", {0, 0, 1}, {0, 2, 0}, {0, 0, 1}, support::diffuse(0.5F))};
    corner.desc.lights = {support::directional_light({-std::sin(angle), 0, -std::cos(angle)}, 1)};
    corner.floor = std::cos(angle) * (1 - support::fresnel(std::cos(angle), water_index));
    corner.wall = corner.floor * std::tan(in_water);
    return corner;
}

/// The share of a disc round a point at that distance from a straight edge that lies within it.
double share_within(double distance) {
    const double h = std::min(1.0, distance / radius);
    return 1 - (std::acos(h) - h * std::sqrt(1 - h * h)) / pi_d;
}

/// Irradiance at that distance from the corner, over eight discs along it.
support::Moments along_corner(const Scene& scene, const CausticEstimator& estimator, bool wall,
                              double distance) {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 8; ++i) {
        const double y = -1.4 + 0.4 * i;
        points.push_back(support::probe(
            scene, wall ? 2 : 1, wall ? Vec3d(0, y, distance) : Vec3d(distance, y, 0),
            wall ? Vec3d::UnitX() : Vec3d::UnitZ(), points.size(), static_cast<float>(radius)));
    }
    support::Moments moments;
    for (const Estimate& estimate : support::irradiance(estimator, points))
        moments.add(static_cast<double>(estimate.value[0]));
    return moments;
}

// What a disc holds beyond the edge of its own surface is dark, so that an estimate there is the truth
// times the disc's share: no more, whatever lights the other side of the corner.
void expect_no_light_round_the_corner(const Scene& scene, const Corner& truth,
                                      const CausticEstimator& estimator) {
    for (const bool wall : {false, true})
        for (const double distance : {0.02, 0.1, 0.25}) {
            const support::Moments found = along_corner(scene, estimator, wall, distance);
            const double expected = (wall ? truth.wall : truth.floor) * share_within(distance);
            EXPECT_LT(found.standard_error(), 0.04 * expected);
            EXPECT_NEAR(found.mean(), expected, 4 * found.standard_error() + 0.005 * expected)
                << (wall ? "wall" : "floor") << ", " << distance << " m from the corner";
        }
}

TEST(Corner, PhotonsOfTheFloorDoNotLightTheWall) {
    const Corner truth = corner();
    const Scene scene(truth.desc);
    for (const photonmap::TreeKind tree :
         {photonmap::TreeKind::balanced, photonmap::TreeKind::unbalanced,
          photonmap::TreeKind::packed}) {
        SCOPED_TRACE(name(tree));
        const auto map = build(scene,
                               photonmap::PhotonMapParams{.photons = 150'000,
                                                          .kernel = photonmap::KernelKind::point,
                                                          .tree = tree,
                                                          .radius = radius},
                               RunOptions{});
        expect_no_light_round_the_corner(scene, truth, *map);
    }
    const auto discs = build(
        scene, photonmap::PhotonMapParams{.photons = 150'000, .radius = radius}, RunOptions{});
    expect_no_light_round_the_corner(scene, truth, *discs);
}

TEST(Corner, PathsToTheFloorDoNotLightTheWall) {
    const Corner truth = corner();
    const Scene scene(truth.desc);
    const auto paths = build(scene, LightTraceParams{.paths = 500'000}, RunOptions{});
    expect_no_light_round_the_corner(scene, truth, *paths);
}

// A ball's top under parallel light: within a chord r of it the light of a disc of radius
// r sqrt(1 - (r / 2R)^2) arrives, spread over pi r^2. No photon is lost up to where its surface faces
// 60 degrees away, at r = R.
TEST(Corner, ABallLosesNoPhotons) {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("water", 3, 2, true, support::glass(static_cast<float>(water_index))),
        support::sphere("ball", Vec3d::Zero(), 1, support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    const Scene scene(desc);
    for (const double r : {0.2, 0.5, 0.9}) {
        const auto map =
            build(scene, photonmap::PhotonMapParams{.photons = 200'000, .radius = r}, RunOptions{});
        const std::vector<ReceiverPoint> top = {
            support::probe(scene, 1, {0, 0, 1}, Vec3d::UnitZ(), 0)};
        const double expected = (1 - support::fresnel(1, water_index)) * (1 - r * r / 4);
        const double photons = 200'000 * r * r * (1 - r * r / 4);
        EXPECT_NEAR(static_cast<double>(support::irradiance(*map, top)[0].value[0]), expected,
                    expected * (4 / std::sqrt(photons) + 0.002))
            << r;
    }
}

}  // namespace
}  // namespace caustics

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/reference/light_trace.h"
#include "core/render/direct_light.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

// A spot light half a metre below a mirror at 1 m shines straight up, and its image at 1.5 m down on
// the floor: E = I f(angle) cos^3(angle) / h^2.
constexpr double spot_height = 1.5;
constexpr double spot_intensity = 5;
constexpr double beam_width = 15;
constexpr double cutoff = 30;
constexpr double distances[] = {0.05, 0.2, 0.38, 0.45, 0.55, 0.65, 0.75, 0.9, 1.2};

double truth(double r) {
    const double angle = std::atan(r / spot_height) * 180 / pi_d;
    const double falloff = std::clamp((cutoff - angle) / (cutoff - beam_width), 0.0, 1.0);
    return spot_intensity * falloff * std::pow(std::cos(angle * pi_d / 180), 3) /
           (spot_height * spot_height);
}

SpotLight spot(const Vec3d& position, const Vec3& axis) {
    return {position.cast<float>(),
            Spectrum(Spectrum::Constant(static_cast<float>(spot_intensity))),
            {axis, static_cast<float>(beam_width * pi_d / 180),
             static_cast<float>(cutoff * pi_d / 180)}};
}

Scene scene() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::horizontal("mirror", 1, 2, false, support::mirror())};
    desc.lights = {spot({0, 0, 0.5}, Vec3::UnitZ())};
    return Scene(std::move(desc));
}

/// Mean over a circle about the axis [W m^-2].
double irradiance(const Scene& scene, const CausticEstimator& method, double r, float radius) {
    std::vector<ReceiverPoint> points;
    for (int k = 0; k < 24; ++k) {
        const double angle = pi_d * (k + 0.3) / 12;
        points.push_back(support::probe(scene, 0, {r * std::cos(angle), r * std::sin(angle), 0},
                                        Vec3d::UnitZ(), static_cast<std::uint64_t>(k), radius));
    }
    double sum = 0;
    for (const Estimate& one : support::irradiance(method, points))
        sum += static_cast<double>(one.value.mean());
    return sum / 24;
}

TEST(Spot, BeamsOfAMirrorFollowTheFalloff) {
    const Scene mirror = scene();
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 128;
    const auto tree = build(mirror, params, {});
    for (const double r : distances)
        EXPECT_NEAR(irradiance(mirror, *tree, r, 0), truth(r), 0.02 * truth(0)) << r;
}

// However narrow, the light is in the beams.
TEST(Spot, ANarrowConeIsNotLostBetweenCorners) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::horizontal("mirror", 1, 2, false, support::mirror())};
    SpotLight thin = spot({0.03, 0.02, 0.5}, Vec3::UnitZ());
    thin.cone.cutoff = 0.02F;
    thin.cone.beam_width = 0.01F;
    desc.lights = {thin};
    const Scene narrow(std::move(desc));
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 4;
    const auto tree = build(narrow, params, {});
    const ReceiverPoint below = support::probe(narrow, 0, {0.03, 0.02, 0}, Vec3d::UnitZ(), 0);
    EXPECT_NEAR(static_cast<double>(support::irradiance(*tree, {below})[0].value.mean()), truth(0),
                0.02 * truth(0));
}

TEST(Spot, PhotonsFollowTheFalloff) {
    const Scene mirror = scene();
    for (const auto emission : {photonmap::PhotonMapParams::Emission::random,
                                photonmap::PhotonMapParams::Emission::stratified}) {
        photonmap::PhotonMapParams params;
        params.photons = 0;
        params.emitted = 400'000;
        params.nearest = 100;
        params.kernel = photonmap::KernelKind::point;
        params.emission = emission;
        const auto map = build(mirror, params, {});
        for (const double r : distances)
            EXPECT_NEAR(irradiance(mirror, *map, r, 0), truth(r), 0.05 * truth(0)) << r;
    }
}

TEST(Spot, TracedLightFollowsTheFalloff) {
    const Scene mirror = scene();
    LightTraceParams params;
    params.paths = 1'000'000;
    const auto traced = build(mirror, params, {});
    for (const double r : distances)
        EXPECT_NEAR(irradiance(mirror, *traced, r, 0.02F), truth(r), 0.05 * truth(0)) << r;
}

TEST(Spot, LightsAFloorDirectly) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {spot({0, 0, spot_height}, -Vec3::UnitZ())};
    const Scene floor(std::move(desc));
    Rng rng(1, Stage::test, 0);
    for (const double r : distances) {
        const ReceiverPoint point = support::probe(floor, 0, {r, 0, 0}, Vec3d::UnitZ(), 0);
        EXPECT_NEAR(static_cast<double>(direct_radiance(floor, point, rng).mean()),
                    0.5 / pi_d * truth(r), 1e-5)
            << r;
    }
}

}  // namespace
}  // namespace caustics

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/illumination_map/illumination_map.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// Two upright mirrors, 0.1 m apart, over a floor: light that falls in at 45 degrees is reflected 24 times on its way
// down, the light of a narrow strip 25 times.
constexpr double mirror_reflectance = 0.97;
constexpr double lower_edge = 0.1;
constexpr double upper_edge = 2.53;

SceneDesc light_guide() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 0.3, true, support::diffuse(0.5F))};
    for (const double x : {-0.05, 0.05})
        desc.shapes.push_back(
            support::rectangle(x < 0 ? "left" : "right", {x, 0, (lower_edge + upper_edge) / 2},
                               {0, 0.25, 0}, {0, 0, (upper_edge - lower_edge) / 2},
                               support::mirror(static_cast<float>(mirror_reflectance))));
    return desc;
}

struct AtFloor {
    double value;
    double error;
};

AtFloor below_the_guide(const CausticEstimator& method, const Scene& scene, double x,
                        double y = 0) {
    ReceiverPoint point = support::probe(scene, 0, {x, y, 0}, Vec3d::UnitZ(), 0, 0.02F);
    const auto hit =
        scene.intersect(Ray{Vec3(point.position + 0.05F * Vec3::UnitZ()), -Vec3::UnitZ()});
    point.uv = hit->uv;
    point.shape = hit->shape;
    const Estimate found = support::irradiance(method, {point})[0];
    return {static_cast<double>(found.value[1]), static_cast<double>(found.standard_error[1])};
}

TEST(ManyEvents, SunlightComesThroughALightGuideByEveryMethodsDefault) {
    SceneDesc desc = light_guide();
    desc.lights = {support::directional_light({-1, 0, -1}, 1)};
    const Scene scene(std::move(desc));
    const double exact = std::pow(mirror_reflectance, 24) * std::sqrt(0.5);
    const auto expect_near = [&](const CausticEstimator& method, double slack, const char* name) {
        const AtFloor found = below_the_guide(method, scene, -0.115);
        EXPECT_NEAR(found.value, exact, 4 * found.error + slack * exact) << name;
        EXPECT_LT(found.error, 0.1 * exact) << name;
    };
    expect_near(*build(scene, LightTraceParams{.paths = 4'000'000}, RunOptions{}), 0, "lighttrace");
    // Beams take 16 events by default.
    beamtree::BeamTreeParams beams;
    beams.max_bounces = 30;
    expect_near(*build(scene, beams, RunOptions{}), 0.005, "beamtree");
    beamtree::CausticPolygonsParams polygons;
    polygons.max_bounces = 30;
    polygons.receiver_resolution = 64;
    expect_near(*build(scene, polygons, RunOptions{}), 0.02, "causticpolygons");
    for (const Interaction interaction : {Interaction::roulette, Interaction::split}) {
        photonmap::PhotonMapParams map;
        map.photons = 0;
        map.emitted = 1'000'000;
        map.interaction = interaction;
        map.radius = 0.02;
        expect_near(*build(scene, map, RunOptions{}), 0.12, "photonmap");
    }
    // The light lies on a strip of 7 cm, and a texel's light reaches two texels far, of 9 mm: a texel has few paths, so
    // the mean along the strip is asked.
    const auto map =
        build(scene, IlluminationMapParams{.emitted = 4'000'000, .resolution = 64}, RunOptions{});
    double sum = 0;
    constexpr int places = 40;
    for (int i = 0; i < places; ++i)
        sum += below_the_guide(*map, scene, -0.115, -0.2 + 0.4 * i / places).value;
    EXPECT_NEAR(sum / places, exact, 0.05 * exact) << "illuminationmap";
}

TEST(ManyEvents, PathsFromTheFloorFindTheLampAboveALightGuide) {
    SceneDesc desc = light_guide();
    desc.shapes.push_back(support::rectangle("lamp", {0, 0, upper_edge + 0.01}, {0, 0.25, 0},
                                             {0.05, 0, 0}, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(10));
    const Scene scene(std::move(desc));
    // From here the guide's lower end is seen aslant, so that light has met its mirrors 16 to 40 times.
    constexpr double beside_the_guide = -0.115;
    const auto by_paths = [&](const PathTraceParams& params) {
        return below_the_guide(*build(scene, params, RunOptions{}), scene, beside_the_guide);
    };
    const AtFloor paths = by_paths({.spp = 400'000});
    const AtFloor light = below_the_guide(
        *build(scene, LightTraceParams{.paths = 2'000'000}, RunOptions{}), scene, beside_the_guide);
    EXPECT_NEAR(paths.value, light.value, 4 * std::hypot(paths.error, light.error));
    EXPECT_LT(paths.error, 0.02 * paths.value);
    EXPECT_LT(by_paths({.spp = 400'000, .max_bounces = 16}).value, 0.9 * paths.value);
}

TEST(ManyEvents, PresetsOfThePapersKeepTheirLimit) {
    EXPECT_EQ(photonmap::PhotonMapParams::jensen1996().max_bounces, 16);
    EXPECT_EQ(beamtree::BeamTreeParams::chuang1995().max_bounces, 16);
}

// In an absorbing medium light has lost nearly all it had on its way down. Most of these paths end by roulette, and
// those that go on make up for them.
TEST(ManyEvents, RouletteByWeightKeepsTheMean) {
    SceneDesc desc = light_guide();
    for (std::size_t i = 1; i < desc.shapes.size(); ++i) desc.shapes[i].bsdf = support::mirror();
    const Scene scene(std::move(desc));
    const Spectrum absorption = Spectrum::Constant(2);
    const LightParticle particle{.ray = Ray{Vec3(0.03F, 0, 2.6F), Vec3(-1, 0, -1).normalized()},
                                 .flux = Spectrum::Ones(),
                                 .medium = &absorption};
    support::Moments arrived;
    std::uint64_t arrivals = 0;
    for (std::uint64_t path = 0; path < 100'000; ++path) {
        Rng rng(1, Stage::test, path);
        LightPathCounts counts;
        std::vector<Deposit> deposits;
        trace_light_path(scene, particle, {}, rng, counts, deposits);
        ASSERT_LE(deposits.size(), 1U);
        arrivals += deposits.size();
        arrived.add(deposits.empty() ? 0 : static_cast<double>(deposits[0].flux[0]));
        EXPECT_EQ(counts.absorbed, deposits.empty() ? 1U : 0U);
    }
    EXPECT_NEAR(arrived.mean(), std::exp(-2 * 2.6 * std::sqrt(2.0)), 4 * arrived.standard_error());
    EXPECT_LT(arrived.standard_error(), 0.02 * arrived.mean());
    EXPECT_LT(arrivals, 10'000U);
}

}  // namespace
}  // namespace caustics

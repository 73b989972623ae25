#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>

#include "beamtree/beam_tree.h"
#include "core/reference/light_trace.h"
#include "core/scene/scene_reader.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

/// A glass ball over a floor under a lamp, of any size and anywhere.
struct BallOverFloor {
    Vec3d place = Vec3d::Zero();  // of the ball's middle [m]
    double radius = 1;            // [m]
    double floor = 4;             // its half side [m]
    int resolution = 0;           // of the ball; 0: exact

    std::string json() const {
        const auto at = [this](double x, double y, double z) {
            const Vec3d p = place + radius * Vec3d(x, y, z);
            return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z());
        };
        return fmt::format(
            R"({{"sensor": {{"type": "perspective"}},
                 "lamp": {{"type": "point", "position": {}, "intensity": {}}},
                 "ball": {{"type": "sphere", "center": {}, "radius": {}{},
                           "bsdf": {{"type": "dielectric", "int_ior": 1.5, "ext_ior": 1}}}},
                 "floor": {{"type": "rectangle", "to_world": [{{"scale": {}}}, {{"translate": {}}}],
                            "bsdf": {{"type": "diffuse"}}}}}})",
            at(0, 0, 4), radius * radius, at(0, 0, 0), radius,
            resolution > 0 ? fmt::format(", \"resolution\": {}", resolution) : "", floor,
            at(0, 0, -1.5));
    }

    Scene scene() const {
        static const support::TemporaryFolder folder("far_scenes_test");
        const auto file = folder.path() / "scene.json";
        std::ofstream(file) << json();
        return Scene(load_scene(file).desc);
    }

    /// Where the ball's caustic lies, and beside it; not on its axis, where light is infinitely dense.
    std::vector<ReceiverPoint> points(const Scene& scene) const {
        std::vector<ReceiverPoint> all;
        for (int i = 0; i < 12; ++i) {
            const double x = 0.01 + 0.08 * i, y = 0.02 * i;
            const Vec3d world = place + radius * Vec3d(x, y, -1.5);
            all.push_back(support::probe(scene, 1, world - scene.origin(), Vec3d::UnitZ(),
                                         static_cast<std::uint64_t>(i),
                                         0.05F * static_cast<float>(radius)));
        }
        return all;
    }
};

template <typename Params>
std::vector<double> answers(const BallOverFloor& ball, const Params& params) {
    const Scene scene = ball.scene();
    RunOptions options;
    options.seed = 3;
    const auto method = build(scene, params, options);
    std::vector<double> all;
    for (const Estimate& e : support::irradiance(*method, ball.points(scene)))
        all.push_back(static_cast<double>(e.value[0]));
    return all;
}

// Every method answers as it does for the same scene elsewhere: with the same random numbers, so that
// only roundings differ.
template <typename Params>
void expect_same(const Params& params, const BallOverFloor& here,
                 const std::vector<BallOverFloor>& there) {
    const auto expected = answers(here, params);
    for (BallOverFloor ball : there) {
        ball.resolution = here.resolution;
        const auto found = answers(ball, params);
        double sum = 0, sum_expected = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i], expected[i], 0.03 * expected[i] + 1e-6)
                << "point " << i << " at " << ball.place.transpose() << ", radius " << ball.radius
                << ", floor " << ball.floor;
            sum += found[i];
            sum_expected += expected[i];
        }
        EXPECT_NEAR(sum / sum_expected, 1, 0.001)
            << ball.place.transpose() << ", radius " << ball.radius << ", floor " << ball.floor;
    }
}

const std::vector<BallOverFloor> far_away = {
    {{1e3, 0, 0}},      {{20000, -10000, 5000}},     {{0, 1e5, 0}},
    {{-1e7, 3e6, 1e5}}, {{30, 0, 0}, 0.0035, 0.014}, {{0, 0, 100}, 0.0035, 0.014}};
const BallOverFloor bead{{0, 0, 0}, 0.0035, 1};
const std::vector<BallOverFloor> wide_floors = {
    {{0, 0, 0}, 0.0035, 1e3}, {{0, 0, 0}, 0.0035, 1e4}, {{30, -40, 0}, 0.0035, 1e4}};

const photonmap::PhotonMapParams photon_map{.photons = 100'000, .nearest = 100};
const LightTraceParams light_trace{.paths = 300'000};

TEST(FarScenes, PhotonMap) {
    expect_same(photon_map, {}, far_away);
    expect_same(photon_map, {.resolution = 32}, far_away);
    expect_same(photon_map, bead, wide_floors);
}

TEST(FarScenes, LightTrace) {
    expect_same(light_trace, {}, far_away);
    expect_same(light_trace, bead, wide_floors);
}

TEST(FarScenes, BeamTree) {
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 24;
    expect_same(params, {}, far_away);
    expect_same(params, bead, wide_floors);
}

// How far from the frame's origin a caster may lie, in its own sizes, is what `notes` promises: other
// casters hold the frame where they are.
SceneDesc ball_at(double distance) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {distance, 0, 0}, 1, support::glass(1.5F)),
                   support::rectangle("floor", {distance, 0, -1.5}, {4, 0, 0}, {0, 4, 0},
                                      support::diffuse(0.5F))};
    desc.lights = {support::point_light({distance, 0, 4}, 1)};
    return desc;
}

constexpr double ball_size = 3.4641;  // the diagonal of its bounds

double arriving_share(double distance) {
    const Scene scene(ball_at(distance));
    const auto counters = build(scene, photon_map, RunOptions{})->build_report().counters;
    return static_cast<double>(counters.at("photons_stored")) /
           static_cast<double>(counters.at("photons_emitted"));
}

TEST(FarScenes, PhotonsKeepTheirFluxToAThousandSizes) {
    const double here = arriving_share(0);
    for (const double sizes : {10, 100, 1000})
        EXPECT_NEAR(arriving_share(sizes * ball_size) / here, 1, 0.001) << sizes;
}

double beam_sum(double distance) {
    const Scene scene(ball_at(distance));
    std::vector<ReceiverPoint> points;
    // Beside the focus, where any rounding shows.
    for (int i = 4; i < 14; ++i)
        points.push_back(support::probe(scene, 1, {distance + 0.08 * i, 0.02 * i, -1.5},
                                        Vec3d::UnitZ(), static_cast<std::uint64_t>(i), 0.05F));
    double sum = 0;
    const auto method = build(scene, beamtree::BeamTreeParams{}, RunOptions{});
    for (const Estimate& e : support::irradiance(*method, points))
        sum += static_cast<double>(e.value[0]);
    return sum;
}

TEST(FarScenes, BeamsKeepTheirLightToTenSizes) {
    EXPECT_NEAR(beam_sum(10 * ball_size) / beam_sum(0), 1, 0.001);
}

}  // namespace
}  // namespace caustics

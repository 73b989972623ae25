#include "beamtree/tracing/rest_photons.h"

#include <gtest/gtest.h>

#include "beamtree/beam_tree.h"
#include "beamtree/rest/photon_discs.h"
#include "beamtree/tracing/traced_scene.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

// In a room that all light comes to.
SceneDesc glass_ball(int resolution) {
    SceneDesc desc = ball_desc(resolution);
    desc.shapes[0].bsdf = support::glass(1.5F);
    desc.shapes[1] = support::enclosure(6, support::diffuse(0.5F));
    return desc;
}

BeamParams params_of(int max_bounces) {
    BeamParams params;
    params.max_bounces = max_bounces;
    return params;
}

TracedScene traced(const Scene& scene, const BeamParams& params, std::uint64_t photons,
                   int threads = 1, std::uint64_t seed = 1) {
    RunOptions options;
    options.threads = threads;
    options.seed = seed;
    return trace_scene(scene, "beams", params, options, Intensity::area, 0, {photons});
}

// By beams that have left the ball [W].
double carried(const TracedScene& traced) {
    double sum = 0;
    for (const BeamSet& set : traced.sets)
        if (set.path.size() > 1 && set.refracted) sum += flux_of(set);
    return sum;
}

// By photons [W].
double brought(const TracedScene& traced) {
    double sum = 0;
    for (const RestPhoton& photon : traced.rest) sum += static_cast<double>(photon.flux.mean());
    return sum;
}

ReceiverPoint floor_point(const Vec3& position) {
    ReceiverPoint point;
    point.position = position;
    point.geometric_normal = Vec3::UnitZ();
    return point;
}

// All of a ball's light that leaves it by its second to fourth event: by beams, and by the brightest of them with photons.
// Beams take the light of a polygon from its corners: the two agree to second order in the mesh.
TEST(RestPhotons, BringWhatBeamsLeaveOut) {
    const Scene scene(glass_ball(24));
    BeamParams params = params_of(4);
    params.prune = 0;
    const double all = carried(traced(scene, params, 0));
    for (const std::int64_t most : {100, 1'000}) {
        params.max_beams = most;
        const TracedScene few = traced(scene, params, 20'000);
        EXPECT_GT(brought(few), 0.05 * all);
        EXPECT_NEAR((carried(few) + brought(few)) / all, 1, 0.01) << most;
    }
}

// Sets of paths that are too weak as a whole are left out in another place.
TEST(RestPhotons, BringWhatIsPruned) {
    const Scene scene(glass_ball(16));
    BeamParams params = params_of(4);
    params.prune = 0;
    const double all = carried(traced(scene, params, 0));
    params.prune = 0.5;
    const TracedScene few = traced(scene, params, 20'000);
    EXPECT_LT(carried(few), 0.99 * all);
    EXPECT_NEAR((carried(few) + brought(few)) / all, 1, 0.01);
    const double share = few.balance.pruned / few.balance.lit;
    EXPECT_NEAR(static_cast<double>(few.rest.size()) / (20'000 * share), 1, 0.1);
}

// A mirror whose light meets a small one above it, which sends it aside.
SceneDesc two_mirrors() {
    SineHeightfield flat;
    flat.half_size = Vec2d::Constant(1);
    SceneDesc desc;
    desc.shapes = {
        support::mesh("large", tessellate_heightfield(flat, 16), Transform::Identity(),
                      support::mirror()),
        support::rectangle("small", {0, 0, 1}, {0, 0.15, 0}, {0.1, 0, -0.1}, support::mirror()),
        support::enclosure(6, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.5, 0.4, 2}, 5)};
    return desc;
}

// Few beams of much light each, that are little together, are left out as one.
TEST(RestPhotons, BringASetThatIsPrunedAsAWhole) {
    const Scene scene(two_mirrors());
    const auto of_two_events = [](const TracedScene& traced) {
        double sum = 0;
        for (const BeamSet& set : traced.sets)
            if (set.path.size() > 1) sum += flux_of(set);
        return sum;
    };
    BeamParams params = params_of(2);
    params.prune = 0;
    const double all = of_two_events(traced(scene, params, 0));
    EXPECT_GT(all, 0);
    params.prune = 0.9;
    const TracedScene few = traced(scene, params, 200'000);
    EXPECT_EQ(of_two_events(few), 0);
    EXPECT_NEAR(few.balance.pruned / all, 1, 0.01);
    EXPECT_NEAR(brought(few) / all, 1, 0.05);
}

TEST(RestPhotons, TakeTheShareOfWhatIsLeftOut) {
    const Scene scene(glass_ball(16));
    BeamParams params = params_of(4);
    params.max_beams = 300;
    const TracedScene few = traced(scene, params, 30'000);
    const double share = (few.balance.pruned + few.balance.over_budget) / few.balance.lit;
    EXPECT_GT(share, 0.05);
    EXPECT_NEAR(static_cast<double>(few.rest.size()) / (30'000 * share), 1, 0.1);
    params.max_beams = 1'000'000;
    EXPECT_LT(traced(scene, params, 30'000).rest.size(), 1'500U);
}

// The light at points, where the beams' and the photons' is added up.
TEST(RestPhotons, CompleteTheLightOfPoints) {
    SceneDesc desc = glass_ball(16);
    desc.shapes[1] = support::horizontal("floor", 0, 4, true, support::diffuse(0.5F));
    const Scene scene(desc);
    BeamTreeParams params;
    params.max_bounces = 2;
    std::vector<ReceiverPoint> points;
    constexpr int cells = 120;
    for (int i = 0; i < cells * cells; ++i)
        points.push_back(floor_point({(static_cast<float>(i % cells) + 0.5F) / cells * 4 - 2,
                                      (static_cast<float>(i / cells) + 0.5F) / cells * 4 - 2, 0}));
    std::uint64_t bytes = 0;
    const auto light = [&] {
        const auto beams = build(scene, params, {});
        bytes = beams->build_report().bytes;
        std::vector<Estimate> estimates(points.size());
        const auto context = beams->make_context();
        beams->irradiance(points, estimates, *context);
        double sum = 0;
        for (const Estimate& one : estimates) sum += static_cast<double>(one.value.mean());
        return sum;
    };
    const double all = light();
    params.max_beams = 100;
    params.rest = BeamTreeParams::Rest::none;
    EXPECT_LT(light(), 0.9 * all);
    const std::uint64_t of_beams = bytes;
    params.rest_photons = 30'000;
    for (const auto rest : {BeamTreeParams::Rest::max_beams, BeamTreeParams::Rest::photons}) {
        params.rest = rest;
        // The focus, of a few cells, is sampled by the grid in one and blurred by discs in the other.
        EXPECT_NEAR(light() / all, 1, 0.03);
        EXPECT_GT(bytes, of_beams + 1'000 * sizeof(Vec3));
    }
}

// Light that prune leaves out is lost, and told, where photons carry that of `max_beams` alone.
TEST(RestPhotons, CarryLightBeyondTheBudgetAlone) {
    const Scene scene(glass_ball(16));
    BeamParams params = params_of(4);
    params.prune = 0.1;
    params.max_beams = 300;
    const TracedScene few = trace_scene(scene, "beams", params, {}, Intensity::area, 0,
                                        {.photons = 200'000, .of_budget_alone = true});
    EXPECT_GT(few.balance.pruned, 0.005 * few.balance.lit);
    EXPECT_GT(few.balance.over_budget, 0.05 * few.balance.lit);
    EXPECT_NEAR(brought(few) / few.balance.over_budget, 1, 0.05);
    EXPECT_NEAR(few.balance.lost, few.balance.pruned, 1e-3 * few.balance.lit);
    // In a room all that is pruned would arrive.
    EXPECT_NEAR(few.balance.missed / few.balance.lost, 1, 0.1);
    for (const RestPhoton& photon : few.rest) EXPECT_FALSE(photon.is_sample);
}

TEST(RestPhotons, AreTheSameWithAnyThreads) {
    const Scene scene(glass_ball(16));
    BeamParams params = params_of(4);
    params.prune = 0.5;
    const TracedScene one = traced(scene, params, 5'000);
    const TracedScene three = traced(scene, params, 5'000, 3);
    ASSERT_EQ(one.rest.size(), three.rest.size());
    for (std::size_t i = 0; i < one.rest.size(); ++i) {
        EXPECT_EQ(one.rest[i].position, three.rest[i].position);
        EXPECT_TRUE((one.rest[i].flux == three.rest[i].flux).all());
    }
    EXPECT_NE(traced(scene, params, 5'000, 1, 2).rest[0].position, one.rest[0].position);
}

TEST(RestPhotons, ChangeNoBeams) {
    const Scene scene(glass_ball(16));
    BeamParams params = params_of(4);
    params.prune = 0.5;
    EXPECT_EQ(carried(traced(scene, params, 1'000)), carried(traced(scene, params, 0)));
    EXPECT_TRUE(traced(scene, params, 0).rest.empty());
}

std::vector<RestPhoton> random_photons(std::size_t count) {
    Rng rng(5, Stage::test, 0);
    std::vector<RestPhoton> photons;
    for (std::size_t i = 0; i < count; ++i) {
        RestPhoton photon{{rng.next(), rng.next(), 0}, Vec3::UnitZ(), Vec3::UnitZ()};
        photon.flux = Spectrum::Constant(1.0F / static_cast<float>(count));
        photons.push_back(photon);
    }
    return photons;
}

// The sum over a grid that reaches beyond all discs is the photons' flux, however they lie.
TEST(PhotonDiscs, SpreadAllLightOfAPlane) {
    const PhotonDiscs discs(random_photons(2'000), 20, 2);
    constexpr int cells = 400;
    constexpr float side = 2.0F / cells;
    double sum = 0;
    std::vector<std::uint32_t> stack;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const Vec3 at((static_cast<float>(i) + 0.5F) * side - 0.5F,
                          (static_cast<float>(j) + 0.5F) * side - 0.5F, 0);
            sum += static_cast<double>(discs.irradiance(floor_point(at), stack).mean());
        }
    EXPECT_NEAR(sum * static_cast<double>(side * side), 1, 1e-3);
}

TEST(PhotonDiscs, AreAskedFromTheirSideAlone) {
    const PhotonDiscs discs(random_photons(500), 20, 1);
    std::vector<std::uint32_t> stack;
    ReceiverPoint point = floor_point({0.5F, 0.5F, 0});
    EXPECT_GT(discs.irradiance(point, stack).mean(), 0.5F);
    point.geometric_normal = -Vec3::UnitZ();
    EXPECT_EQ(discs.irradiance(point, stack).mean(), 0);
}

}  // namespace
}  // namespace caustics::beamtree

#include "beamtree/tracing/beam_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "beamtree/tracing/beam_tracing.h"
#include "beamtree/tracing/expected_least.h"
#include "beamtree/tracing/traced_scene.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

std::vector<double> random_lights(int count) {
    Rng rng(3, Stage::test, 0);
    std::vector<double> lights;
    for (int i = 0; i < count; ++i) lights.push_back(std::exp2(-20 * rng.next_fine()));
    return lights;
}

std::uint64_t count_from(const std::vector<double>& lights, double least) {
    return static_cast<std::uint64_t>(
        std::ranges::count_if(lights, [&](double light) { return light >= least; }));
}

// As many as fit, but for one step of light; and what has more than the least always fits.
TEST(BeamBudget, TellsWhatTheBrightestHaveAtLeast) {
    std::vector<double> lights = random_lights(5'000);
    for (const std::uint64_t most : {1U, 50U, 700U, 4'999U}) {
        BeamBudget budget(most);
        for (const double light : lights) budget.count(light);
        EXPECT_TRUE(budget.is_over());
        EXPECT_LE(count_from(lights, budget.least()), most);
        EXPECT_GT(count_from(lights, budget.least() / (1 + 2.0 / 16)), most);
        EXPECT_TRUE(budget.all_have(budget.least()));
    }
    BeamBudget roomy(5'000);
    for (const double light : lights) roomy.count(light);
    EXPECT_FALSE(roomy.is_over());
    EXPECT_EQ(roomy.least(), 0);
}

TEST(BeamBudget, DoesNotKnowAnOrder) {
    std::vector<double> lights = random_lights(3'000);
    BeamBudget forward(400), backward(400), joined(400), one(400), other(400);
    for (const double light : lights) forward.count(light);
    std::ranges::reverse(lights);
    for (const double light : lights) backward.count(light);
    for (std::size_t i = 0; i < lights.size(); ++i) (i % 3 == 0 ? one : other).count(lights[i]);
    joined.add(one);
    joined.add(other);
    EXPECT_EQ(forward.least(), backward.least());
    EXPECT_EQ(forward.least(), joined.least());
}

TEST(BeamBudget, KeepsAsManyAsItIsFor) {
    BeamBudget part(3), all(3);
    for (const double light : {1, 2, 3}) part.count(light);
    all.add(part);
    for (const BeamBudget& budget : {part, all}) {
        EXPECT_FALSE(budget.is_over());
        EXPECT_EQ(budget.count(), 3U);
        EXPECT_TRUE(budget.has_room_for(0));
        EXPECT_FALSE(budget.has_room_for(1));
    }
}

// A budget of one beam drew two thousand polygons of a mesh of two hundred, and took longer than one of thousands.
TEST(BeamBudget, DrawsNoMorePolygonsThanThereAre) {
    EXPECT_LE(draw_count(192, 1), 192U);
    EXPECT_LE(draw_count(192, 2'000), 192U);
    EXPECT_LE(draw_count(1e6, 1), 2'000U);
    EXPECT_GE(draw_count(12, 1'000'000), 16U);
    EXPECT_LT(draw_count(1e5, 1'000'000), draw_count(1e5, 100'000));
}

SceneDesc glass_ball() {
    SceneDesc desc = ball_desc(16);
    desc.shapes[0].bsdf = support::glass(1.5F);
    return desc;
}

double light_of(const TracedScene& traced) {
    double sum = 0;
    for (const BeamSet& set : traced.sets)
        for (const Beam& beam : set.beams)
            if (set.path.size() > 1) sum += static_cast<double>(beam.flux.mean());
    return sum;
}

std::uint64_t count_of(const TracedScene& traced) {
    std::uint64_t count = traced.unreceived;
    for (const BeamSet& set : traced.sets)
        if (set.path.size() > 1) count += set.beams.size();
    return count;
}

BeamParams with_most(std::int64_t most) {
    BeamParams params;
    params.max_beams = most;
    return params;
}

// A beam whose light media leave none of that floats hold has all light, were media clear.
TEST(BeamBudget, KeepsWhatIsInfinitelyBright) {
    BeamBudget budget(1);
    budget.count(1);
    budget.count(std::numeric_limits<double>::infinity());
    EXPECT_EQ(budget.count(), 1U);
    EXPECT_GT(budget.least(), 1);
    EXPECT_FALSE(budget.all_have(std::numeric_limits<double>::infinity()));
    EXPECT_TRUE(budget.all_have(2));
}

// Those that are kept, and no others, have so much light.
void expect_brightest(const TracedScene& some, const TracedScene& all) {
    std::size_t bright = 0, kept = 0;
    for (const BeamSet& set : all.sets)
        if (set.path.size() > 1)
            for (const Beam& beam : set.beams)
                bright += static_cast<double>(beam.flux.mean()) >= some.least_light ? 1 : 0;
    for (const BeamSet& set : some.sets)
        if (set.path.size() > 1)
            for (const Beam& beam : set.beams) {
                EXPECT_GE(static_cast<double>(beam.flux.mean()), 0.999 * some.least_light);
                ++kept;
            }
    EXPECT_NEAR(static_cast<double>(kept) / static_cast<double>(bright), 1, 0.02);
}

TEST(BeamBudget, KeepsTheBeamsWithTheMostLight) {
    const Scene scene(glass_ball());
    const TracedScene all = trace_scene(scene, "beams", {}, {});
    EXPECT_EQ(all.balance.over_budget, 0);
    EXPECT_EQ(all.least_light, 0);
    double before = 0;
    for (const std::int64_t most : {500, 1'000, 2'000}) {
        const TracedScene some = trace_scene(scene, "beams", with_most(most), {});
        EXPECT_LE(count_of(some), static_cast<std::uint64_t>(most) + some.unreceived);
        EXPECT_GT(some.least_light, 0);
        EXPECT_GT(some.balance.over_budget, 0);
        EXPECT_GT(light_of(some), before);
        before = light_of(some);
        expect_brightest(some, all);
    }
    const TracedScene roomy = trace_scene(scene, "beams", with_most(1'000'000), {});
    EXPECT_EQ(light_of(roomy), light_of(all));
}

// Lights and casters share the budget by their light; who traces them changes nothing.
TEST(BeamBudget, IsSharedByLightsTheSameWithAnyThreads) {
    SceneDesc desc = glass_ball();
    desc.lights.push_back(support::point_light({-1, 0.3, 2}, 0.5F));
    desc.lights.push_back(support::point_light({-1, -0.8, 1.4}, 2));
    const Scene scene(std::move(desc));
    RunOptions two;
    two.threads = 2;
    const TracedScene one = trace_scene(scene, "beams", with_most(1'500), {});
    const TracedScene other = trace_scene(scene, "beams", with_most(1'500), two);
    EXPECT_EQ(one.least_light, other.least_light);
    expect_brightest(one, trace_scene(scene, "beams", {}, {}));
    ASSERT_EQ(one.sets.size(), other.sets.size());
    for (std::size_t i = 0; i < one.sets.size(); ++i) {
        ASSERT_EQ(one.sets[i].beams.size(), other.sets[i].beams.size());
        for (std::size_t k = 0; k < one.sets[i].beams.size(); ++k)
            EXPECT_TRUE((one.sets[i].beams[k].flux == other.sets[i].beams[k].flux).all());
    }
}

// Parts of polygons with little light are not divided: fewer beams, and what they would have carried is told as lost.
TEST(BeamBudget, DividesOnlyWhatHasLight) {
    const Scene scene(glass_ball());
    const std::vector<CasterMesh> casters = caster_meshes(scene, 16);
    const std::vector<LightSample> lights = sample_lights(scene, 1, 1);
    const auto traced = [&](double least) {
        return trace_all_beams(scene, casters, lights,
                               {.max_bounces = 6, .prune = 0, .least_divided = least}, {});
    };
    const auto count = [](const TracedBeams& beams) {
        std::size_t sum = 0;
        for (const BeamSet& set : beams.sets) sum += set.beams.size();
        return sum;
    };
    const TracedBeams all = traced(0), most = traced(1e-3), some = traced(0.1), none = traced(1e9);
    EXPECT_LT(count(most), count(all));
    EXPECT_LT(count(some), count(most));
    EXPECT_LT(count(none), count(some));
    EXPECT_NEAR(all.balance.lost, 0, 1e-12 * all.balance.lit);
    EXPECT_LT(most.balance.lost, 1e-6 * most.balance.lit);
    EXPECT_GT(some.balance.lost, 1e-6 * some.balance.lit);
    EXPECT_GT(none.balance.lost, some.balance.lost);
    EXPECT_LT(none.balance.lost, 1e-3 * none.balance.lit);
}

// A ball within a ball, of facets, whose light parts widely.
SceneDesc nested_facets() {
    SceneDesc desc;
    for (const double radius : {0.5, 0.3}) {
        const Transform place(Eigen::Translation3d(0, 0, 0.6) * Eigen::Scaling(radius));
        const Bsdf bsdf = radius < 0.5 ? support::glass(1, 1.5F) : support::glass(1.5F);
        desc.shapes.push_back(
            support::mesh("ball" + std::to_string(radius), tessellate_sphere(8), place, bsdf));
        desc.shapes.back().mesh.normals.clear();
    }
    desc.shapes.push_back(support::horizontal("floor", 0, 4, true, support::diffuse(0.5F)));
    desc.lights = {support::point_light({1.5, 0.4, 1.6}, 5)};
    return desc;
}

// However many polygons another caster has, here below the floor.
TEST(BeamBudget, DividesPolygonsAlikeBesideAFineMesh) {
    const auto lost = [](const SceneDesc& desc) {
        BeamParams params;
        params.max_bounces = 2;
        const TracedScene traced = trace_scene(Scene(desc), "beams", params, {});
        return traced.balance.lost / traced.balance.lit;
    };
    SceneDesc desc = nested_facets();
    const double alone = lost(desc);
    EXPECT_GT(alone, 0.01);
    desc.shapes.push_back(support::mesh("water", tessellate_heightfield(waves(), 150),
                                        Transform(Eigen::Translation3d(0, 0, -2)),
                                        support::glass(1.333F)));
    EXPECT_NEAR(lost(desc) / alone, 1, 1e-3);
}

// Of many polygons in many lights each has little of all light, but of a polygon's own a thousandth is divided.
TEST(BeamBudget, DividesByAllLightOrByThatOfAPolygon) {
    const TraceSettings settings{.least_divided = 0x1p-10, .divided_share = 0x1p-21};
    EXPECT_EQ(least_to_divide(settings, 2, 1), 0x1p-20);
    EXPECT_EQ(least_to_divide(settings, 4, 8), 0x1p-16);
    EXPECT_EQ(least_to_divide(settings, 1'000'000, 16), 0x1p-10);
    EXPECT_EQ(least_to_divide({.least_divided = 0.25}, 2, 1), 0.25);
    EXPECT_EQ(least_to_divide({}, 2, 1), 0);
}

// What is left out is told: prune and budget each by its share.
TEST(BeamBudget, TellsWhatIsLeftOut) {
    const Scene scene(glass_ball());
    const auto share = [&](const BeamParams& params, const char* name) {
        return trace_scene(scene, "beams", params, {}).report().resolved.at(name);
    };
    BeamParams weak;
    weak.prune = 0.2;
    EXPECT_EQ(share({}, "flux_share_over_budget"), 0);
    EXPECT_GT(share(weak, "flux_share_pruned"), 10 * share({}, "flux_share_pruned"));
    EXPECT_EQ(share(weak, "flux_share_over_budget"), 0);
    const BeamParams few = with_most(700);
    EXPECT_GT(share(few, "flux_share_over_budget"), 0.02);
    EXPECT_NEAR(share(few, "flux_share_captured") + share(few, "flux_share_over_budget"),
                share({}, "flux_share_captured"), 0.03);
}

}  // namespace
}  // namespace caustics::beamtree

#include "beamtree/tracing/kept_beams.h"

#include <gtest/gtest.h>

#include "beamtree/beam_tree.h"
#include "beamtree/tracing/traced_scene.h"
#include "tests/beamtree/beam_scenes.h"
#include "tests/support/random_direction.h"

namespace caustics::beamtree {
namespace {

Vec3 random_place(Rng& rng) { return 2 * Vec3(rng.next(), rng.next(), rng.next()) - Vec3::Ones(); }

BeamSet one_beam(Rng& rng) {
    BeamSet set;
    const Vec3 place = random_place(rng);
    const Vec3 way = random_place(rng).normalized();
    for (int i = 0; i < 3; ++i)
        set.rays.push_back(
            {place + 0.1F * random_place(rng), Vec3(way + 0.3F * random_place(rng)).normalized()});
    set.beams.push_back({.corners = {0, 1, 2, Beam::none}});
    return set;
}

// A mean of places on the rays: what any test plane may find inside the beam.
Vec3 place_inside(const BeamSet& set, Rng& rng) {
    Vec3 shares(rng.next(), rng.next(), rng.next());
    shares /= shares.sum();
    Vec3 place = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
        place += shares[static_cast<Eigen::Index>(i)] *
                 (set.rays[i].position + 4 * rng.next() * set.rays[i].direction);
    return place;
}

TEST(KeptBeams, HoldAllThatABeamMayLight) {
    Rng rng(1, Stage::test, 0);
    int left_out = 0;
    for (int i = 0; i < 2'000; ++i) {
        const BeamSet set = one_beam(rng);
        SceneBoxes boxes;
        const Vec3 corner = 2 * random_place(rng);
        const Vec3 size = 0.5F * Vec3(rng.next(), rng.next(), rng.next());
        boxes.receivers = {Box(corner, corner + size)};
        const bool meets = may_meet_receiver(boxes, set, set.beams[0], 0);
        left_out += meets ? 0 : 1;
        for (int k = 0; k < 100; ++k)
            EXPECT_TRUE(meets || !boxes.receivers[0].contains(place_inside(set, rng))) << i;
        // A margin holds what lies off the box by less.
        EXPECT_TRUE(may_meet_receiver(boxes, set, set.beams[0], 100));
    }
    EXPECT_GT(left_out, 400);
}

// Steep waves send the light of a coarse polygon's middle down, and that of its corners up.
TEST(KeptBeams, AreThoseOfCurvedPolygonsWhoseCornersRaysPassTheReceiver) {
    Rng rng(1, Stage::test, 0);
    BeamSet set = one_beam(rng);
    const std::array<Vec3, 3> ways = {Vec3(0.9F, 0, 0.1F), Vec3(-0.9F, 0, 0.3F),
                                      Vec3(0, 0.9F, 0.2F)};
    for (std::size_t i = 0; i < 3; ++i) {
        set.rays[i].position = 0.1F * ways[i];
        set.rays[i].direction = ways[i].normalized();
    }
    SceneBoxes boxes;
    boxes.receivers = {Box(Vec3(-1, -1, -1), Vec3(1, 1, -0.9F))};
    EXPECT_FALSE(may_meet_receiver(boxes, set, set.beams[0], 0));
    EXPECT_TRUE(may_meet_receiver(boxes, set, set.beams[0], 0, true));
    // Rays that part little do not come back.
    for (std::size_t i = 0; i < 3; ++i)
        set.rays[i].direction = (Vec3(0, 0, 1) + 0.01F * ways[i]).normalized();
    EXPECT_FALSE(may_meet_receiver(boxes, set, set.beams[0], 0, true));
}

// Half of all beams of a pool go up; without them its floor has the same light to the bit.
TEST(KeptBeams, AreHalfOfAPools) {
    const Scene scene(pool_desc(12));
    const std::vector<CasterMesh> casters = caster_meshes(scene, 12);
    const std::vector<LightSample> lights = sample_lights(scene, 1, 1);
    for (const Intensity intensity : {Intensity::area, Intensity::refined})
        for (const int bounces : {1, 3}) {
            TraceSettings settings{.intensity = intensity, .max_bounces = bounces};
            const TracedBeams all = trace_all_beams(scene, casters, lights, settings, {});
            settings.receiver_margin = 1e-3F;
            const TracedBeams kept = trace_all_beams(scene, casters, lights, settings, {});
            ASSERT_EQ(all.sets.size(), 2U);
            // Refined beams are kept, too, where rays between their corners may turn back.
            const std::size_t upwards = all.sets[0].beams.size();
            const std::size_t curved = kept.sets.size() == 1 ? 0 : kept.sets[0].beams.size();
            EXPECT_LT(curved, intensity == Intensity::area ? 1 : upwards / 10);
            EXPECT_TRUE(kept.sets.back().refracted);
            EXPECT_EQ(kept.unreceived, upwards - curved);
            EXPECT_EQ(kept.balance.lit, all.balance.lit);
            const BeamSet& before = all.sets[1];
            const BeamSet& after = kept.sets.back();
            ASSERT_EQ(after.beams.size(), before.beams.size());
            for (std::size_t i = 0; i < before.beams.size(); ++i)
                EXPECT_EQ(after.beams[i].corners, before.beams[i].corners);
            ASSERT_EQ(after.spreads.size(), before.spreads.size());
            for (std::size_t i = 0; i < before.spreads.size(); ++i)
                EXPECT_EQ(after.spreads[i].linear, before.spreads[i].linear);
        }
}

// A mirror ball sends light up and down: beams that stay keep the spreads that they have among all.
TEST(KeptBeams, KeepTheirSpreadsAmongOthersThatGo) {
    const Scene scene(ball_desc(24));
    const std::vector<CasterMesh> casters = caster_meshes(scene, 12);
    TraceSettings settings{.intensity = Intensity::refined, .max_bounces = 2};
    const std::vector<LightSample> lights = sample_lights(scene, 1, 1);
    const BeamSet all = trace_all_beams(scene, casters, lights, settings, {}).sets.at(0);
    settings.receiver_margin = 1e-3F;
    const TracedBeams traced = trace_all_beams(scene, casters, lights, settings, {});
    const BeamSet& kept = traced.sets.at(0);
    EXPECT_GT(traced.unreceived, 0U);
    ASSERT_EQ(kept.beams.size() + traced.unreceived, all.beams.size());
    ASSERT_EQ(kept.rays.size(), all.rays.size());
    std::size_t known = 0;
    for (const Beam& beam : kept.beams)
        for (std::size_t i = 0; i < 3; ++i) {
            const RaySpread& spread = kept.spreads[beam.corners[i]];
            EXPECT_EQ(spread.constant, all.spreads[beam.corners[i]].constant);
            EXPECT_EQ(spread.quadratic, all.spreads[beam.corners[i]].quadratic);
            known += spread.is_known() ? 1 : 0;
        }
    EXPECT_GT(known, kept.beams.size());
}

TEST(KeptBeams, CountTheOthersInTheReport) {
    const Scene scene(pool_desc(12));
    BeamTreeParams params;
    params.intensity = Intensity::area;
    const BuildReport by_area = build(scene, params, RunOptions{})->build_report();
    EXPECT_EQ(by_area.counters.at("beams_unreceived"), by_area.counters.at("beams"));
    // Rays between the corners may go further: a few more beams are kept.
    const BuildReport refined = build(scene, BeamTreeParams{}, RunOptions{})->build_report();
    EXPECT_LE(refined.counters.at("beams_unreceived"), by_area.counters.at("beams_unreceived"));
    EXPECT_GT(refined.counters.at("beams_unreceived"),
              by_area.counters.at("beams_unreceived") * 9 / 10);
}

}  // namespace
}  // namespace caustics::beamtree

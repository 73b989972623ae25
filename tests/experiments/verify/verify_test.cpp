#include <gtest/gtest.h>

#include <cmath>

#include "experiments/gallery/meridian.h"
#include "experiments/verify/light_audit.h"
#include "experiments/verify/verify_gallery.h"
#include "tests/experiments/named_scene.h"

namespace caustics::experiments {
namespace {

Series beams() {
    return {"beamtree", {{16, {"mesh_resolution=16"}}, {32, {"mesh_resolution=32"}}}, 2, 0.1, 0,
            {}};
}

TEST(Gallery, HasAtLeastTwelveScenesWithPointsAndSeries) {
    const std::vector<GalleryScene> scenes = gallery();
    EXPECT_GE(scenes.size(), 12U);
    for (const GalleryScene& scene : scenes) {
        EXPECT_GE(scene.points.size(), 50U) << scene.name;
        EXPECT_GE(scene.series.size(), 3U) << scene.name;
        for (const KnownPoint& point : scene.points) {
            EXPECT_GT(point.truth, 0) << scene.name;
            EXPECT_TRUE(std::isfinite(point.truth)) << scene.name;
        }
    }
}

// The mirror of a point light by Meridian's quadrature against the image's closed form: the ray at
// the angle u from the light at z = 1 lands (2 - 1 + 2) tan u from the axis.
TEST(Gallery, TheQuadratureIsGoodToAMillionth) {
    const Meridian light{[](double u) { return Landing{3 * std::tan(u), 1}; },
                         [](double u) { return 2 * pi_d * 4 * std::sin(u); }, 0, 1.2};
    for (const double r : {0.01, 0.3, 1.0, 2.5})
        EXPECT_NEAR(light.irradiance(r) / (4 * 3 / std::pow(r * r + 9, 1.5)), 1, 1e-7) << r;
    // Both sides of the axis count: a ray to -r lights the place as one to r does.
    const Meridian crossed{[](double u) { return Landing{-3 * std::tan(u), 1}; }, light.flux, 0,
                           1.2};
    EXPECT_NEAR(crossed.irradiance(0.3), light.irradiance(0.3), 1e-9);
}

TEST(Gallery, AWrongTruthDoesNotHold) {
    GalleryScene scene = scene_named("plane_mirror");
    EXPECT_TRUE(run_series(scene, beams(), RunOptions{}).holds());
    for (KnownPoint& point : scene.points) point.truth *= 1.02;
    const SeriesOutcome off = run_series(scene, beams(), RunOptions{});
    EXPECT_FALSE(off.is_balanced());
    for (KnownPoint& point : scene.points) point.truth *= pi_d;
    const SeriesOutcome wrong = run_series(scene, beams(), RunOptions{});
    EXPECT_FALSE(wrong.is_small_enough());
    EXPECT_FALSE(wrong.falls_fast_enough());
    EXPECT_NE(gallery_table({scene}, {wrong}).find("**too large**"), std::string::npos);
}

TEST(Gallery, WhatAMethodRefusesIsTold) {
    const Series series{"pathtrace", {{0, {"spp=1"}}, {0, {"spp=4"}}}, 2, 0.1, 0, {}};
    const GalleryScene scene = scene_named("plane_mirror");
    const SeriesOutcome outcome = run_series(scene, series, RunOptions{});
    EXPECT_NE(outcome.refusal.find("point light"), std::string::npos);
    EXPECT_TRUE(outcome.holds());
    EXPECT_NE(gallery_table({scene}, {outcome}).find("cannot serve it"), std::string::npos);
}

// Behind dark glass all light is weak, and none of it may be left out for that.
TEST(Gallery, BeamsFollowTheLightThroughDarkGlass) {
    const std::vector<std::string> parameters = {"mesh_resolution=128", "max_bounces=2"};
    const Series series{"beamtree", {{0, parameters}}, 1, 0.08, 0, {}};
    const SeriesOutcome outcome = run_series(scene_named("dark_ball"), series, RunOptions{});
    EXPECT_NEAR(outcome.mean, 1, 0.01);
}

// Through a plane mirror all of what meets it goes on to the floor or past it.
TEST(LightAudit, AccountsForTheLightOfAMirror) {
    const std::vector<LightAccount> accounts =
        audit_lights(scene_named("plane_mirror").make(0), 16);
    ASSERT_EQ(accounts.size(), 1U);
    const LightAccount& account = accounts.front();
    EXPECT_TRUE(account.holds());
    EXPECT_NEAR(account.sent,
                account.missed + account.escaped + account.absorbed + account.on_black_side +
                    account.depth_limited + account.arrived,
                1e-9 * account.sent);
    EXPECT_NEAR(account.absorbed, 0, 1e-6 * account.sent);
    EXPECT_GT(account.arrived, 0);
    LightAccount wrong = account;
    wrong.arrived *= 1.1;
    EXPECT_FALSE(wrong.holds());
    wrong = account;
    wrong.arrived = wrong.arrived_by_branches = 1.01 * account.sent;
    EXPECT_FALSE(wrong.holds());
}

TEST(LightAudit, SaysWhyNoLightIsSent) {
    SceneDesc desc = scene_named("plane_mirror").make(0);
    desc.shapes.pop_back();  // the mirror
    const std::vector<LightAccount> accounts = audit_lights(desc, 16);
    ASSERT_EQ(accounts.size(), 1U);
    EXPECT_FALSE(accounts.front().nothing_aimed.empty());
}

}  // namespace
}  // namespace caustics::experiments

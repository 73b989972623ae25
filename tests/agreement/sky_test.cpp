#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/base/error.h"
#include "core/light_path/aimed_emission.h"
#include "core/method/none.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/direct_light.h"
#include "core/render/eye_path.h"
#include "core/render/renderer.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// A ball above a receiver so small and dark that it changes nothing, under a sky that is the same all
// around. The ball takes a share (R / d)^2 of the sky from the receiver, and gives it back: as a mirror
// that reflects all, as clear glass through and through.
constexpr double radiance = 3;
constexpr double ball_radius = 0.7;
constexpr double ball_height = 2;
constexpr double share = ball_radius * ball_radius / (ball_height * ball_height);

Scene under_the_sky(const Bsdf& ball) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("receiver", 0, 0.05, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, ball_height}, ball_radius, ball)};
    desc.lights = {ConstantLight{Spectrum(Spectrum::Constant(static_cast<float>(radiance)))}};
    return Scene(std::move(desc));
}

ReceiverPoint below(const Scene& scene) {
    return support::probe(scene, 0, {0, 0, 0}, Vec3d::UnitZ(), 3, 0.04F);
}

Bsdf dispersive_glass() {
    Bsdf bsdf = support::glass(1.5F);
    std::get<Dielectric>(bsdf.model).int_ior = Ior::cauchy(1.5, 0.02);
    return bsdf;
}

TEST(Sky, LightsAnOpenFloorByPiTimesItsRadiance) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 5, true, support::diffuse(0.5F))};
    desc.lights = {ConstantLight{Spectrum(1, 2, 3)}};
    const Scene scene(std::move(desc));
    Rng rng(1, Stage::test, 0);
    const ReceiverPoint point = support::probe(scene, 0, {1, 0, 0}, Vec3d::UnitZ(), 0);
    const Spectrum leaving = direct_radiance(scene, point, rng);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(leaving[c], 0.5F * static_cast<float>(c + 1), 1e-5F);
}

TEST(Sky, IsHiddenByABallInDirectLight) {
    const Scene scene = under_the_sky(support::mirror());
    support::Moments direct;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Rng rng(1, Stage::test, i);
        direct.add(static_cast<double>(direct_radiance(scene, below(scene), rng)[0]) / 0.5);
    }
    EXPECT_NEAR(direct.mean(), radiance * (1 - share), 4 * direct.standard_error());
}

TEST(Sky, MirrorsAndGlassGiveBackAsMuchAsTheyHide) {
    const double expected = pi_d * radiance * share;
    for (const Bsdf& ball : {support::mirror(), support::glass(1.5F), dispersive_glass()}) {
        const Scene scene = under_the_sky(ball);
        const auto near = [&](const CausticEstimator& method, double slack) {
            const Estimate found = support::irradiance(method, {below(scene)})[0];
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(found.value[c]), expected,
                            4.5 * static_cast<double>(found.standard_error[c]) + slack * expected);
            EXPECT_LT(found.standard_error.maxCoeff(), 0.15 * expected);
        };
        near(*build(scene, PathTraceParams{.spp = 20'000, .max_bounces = 64}, RunOptions{}), 1e-3);
        near(*build(scene, LightTraceParams{.paths = 1'500'000, .max_bounces = 64}, RunOptions{}),
             5e-3);
        photonmap::PhotonMapParams map;
        map.photons = 0;
        map.emitted = 1'500'000;
        map.radius = 0.04;
        map.max_bounces = 64;
        near(*build(scene, map, RunOptions{}), 0.3);
    }
}

// L 4 pi of directions through the ball's disc.
TEST(Sky, AimsAllLightThatMeetsTheCasters) {
    const Scene scene = under_the_sky(support::mirror());
    EXPECT_NEAR(static_cast<double>(AimedEmission(scene).total_power()[0]) /
                    (radiance * 4 * pi_d * pi_d * ball_radius * ball_radius),
                1, 1e-4);
    // Two casters that overlap are not lit twice.
    SceneDesc desc;
    desc.shapes = {support::sphere("a", {0, 0, 0}, 1, support::mirror()),
                   support::sphere("b", {0.5, 0, 0}, 1, support::mirror()),
                   support::enclosure(20, support::diffuse(0))};
    desc.lights = {ConstantLight{}};
    const Scene two(std::move(desc));
    const AimedEmission emission(two);
    std::uint64_t sent = 0;
    constexpr std::uint64_t tries = 100'000;
    for (std::uint64_t i = 0; i < tries; ++i) {
        Rng rng(1, Stage::test, i);
        sent += emission.emit(rng) ? 1 : 0;
    }
    // The union of two overlapping discs, over all directions, lies between one disc and two.
    const double kept = static_cast<double>(sent) / tries;
    EXPECT_GT(kept, 0.5);
    EXPECT_LT(kept, 0.75);
}

TEST(Sky, IsSeenByTheEyeWhereNothingIs) {
    const Scene scene = under_the_sky(support::mirror());
    std::vector<WeightedPoint> points;
    Rng rng(1, Stage::test, 0);
    const auto towards = [&](const Vec3& direction) {
        return trace_eye_path(scene, Ray{Vec3(0, 0, 1), direction}, black(), rng, points).emitted;
    };
    EXPECT_EQ(towards(Vec3::UnitX())[1], static_cast<float>(radiance));
    EXPECT_NEAR(towards(Vec3(0.05F, 0, 1).normalized())[1], radiance, 1e-5);
}

TEST(Sky, IsRefusedByBeams) {
    const Scene scene = under_the_sky(support::mirror());
    EXPECT_THROW(build(scene, beamtree::BeamTreeParams{}, RunOptions{}), UnsupportedScene);
}

// Albedo times radiance, without shadows, in a layer of its own.
TEST(Ambient, IsALayerThatBeautyHolds) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 5, true, support::diffuse(0.25F)),
                   support::sphere("ball", {0, 0, 1}, 0.5, support::mirror())};
    desc.lights = {support::point_light({0, 0, 3}, 1)};
    desc.camera = support::camera({0, -4, 2}, {0, 0, 0.5}, {0, 0, 1}, 40, 16, 12);
    const auto picture = [&](const Spectrum& ambient) {
        SceneDesc own = desc;
        own.ambient = ambient;
        const Scene scene(std::move(own));
        const RunOptions options;
        return render(scene, *build(scene, NoneParams{}, options), options).film;
    };
    const Film with = picture(Spectrum(1, 2, 4));
    const Film without = picture(black());
    EXPECT_FALSE(without.has_layer("ambient"));
    ASSERT_TRUE(with.has_layer("ambient"));
    int lit = 0;
    for (std::size_t pixel = 0; pixel < with.pixel_count(); ++pixel) {
        const Spectrum ambient = with.rgb("ambient", pixel);
        const Spectrum sum = without.rgb("", pixel) + ambient;
        EXPECT_TRUE((with.rgb("", pixel) - sum).abs().maxCoeff() < 1e-6F) << pixel;
        if (ambient[0] == 0.25F) {
            EXPECT_EQ(ambient[2], 1);
            ++lit;
        }
    }
    EXPECT_GT(lit, 30);
}

}  // namespace
}  // namespace caustics

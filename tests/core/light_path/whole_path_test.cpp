#include "core/light_path/whole_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/light_path/aimed_emission.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

// What roulette leaves out is in the share of the paths that go on, not in their flux: no path gains any, however often it
// comes to a surface that both mirrors and scatters light. Else few paths would carry most of it.
TEST(WholePath, NeverGainsFlux) {
    Bsdf blend = support::diffuse(0.8F);
    blend.mirror = MirrorPart{0.5F, Spectrum(Spectrum::Constant(0.9F))};
    SceneDesc desc;
    desc.shapes = {support::enclosure(1, blend)};
    desc.lights = {support::point_light({0, 0, 0}, 1)};
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene, Isa::plain, Aim::everywhere);
    LightPathCounts counts;
    std::size_t longest = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Rng rng(1, Stage::test, i);
        const auto particle = emission.emit(rng);
        ASSERT_TRUE(particle);
        std::vector<Deposit> deposits;
        trace_whole_path(scene, *particle, {}, rng, counts, deposits);
        for (const Deposit& deposit : deposits)
            EXPECT_LE(deposit.flux.sum(), 1.0001F * particle->flux.sum());
        longest = std::max(longest, deposits.size());
    }
    EXPECT_GT(longest, 20U);
}

constexpr std::uint64_t whole_paths = 10'000;

// What becomes of so many particles that leave (0, 0, 3) straight down.
LightPathCounts traced_down(const std::vector<Shape>& shapes, const WholePathSettings& settings) {
    SceneDesc desc;
    desc.shapes = shapes;
    const Scene scene(std::move(desc));
    const LightParticle particle{{Vec3(0, 0, 3), -Vec3::UnitZ()}, Spectrum(1, 0.5F, 0.25F)};
    LightPathCounts counts;
    std::vector<Deposit> deposits;
    for (std::uint64_t path = 0; path < whole_paths; ++path) {
        Rng rng(2, Stage::test, path);
        trace_whole_path(scene, particle, settings, rng, counts, deposits);
    }
    EXPECT_EQ(deposits.size(), counts.stored);
    return counts;
}

double chance_of(double share) {
    return 4 * std::sqrt(static_cast<double>(whole_paths) * share * (1 - share));
}

TEST(WholePath, EndsInWhatAbsorbs) {
    // A mirror that keeps 0.3; what it sends back leaves the scene.
    const LightPathCounts dull =
        traced_down({support::horizontal("mirror", 0, 1, true, support::mirror(0.3F))}, {});
    EXPECT_NEAR(static_cast<double>(dull.absorbed), 0.7 * whole_paths, chance_of(0.7));
    EXPECT_EQ(dull.escaped, dull.reflected);
    EXPECT_EQ(dull.absorbed + dull.escaped, whole_paths);
    // Ink over a floor: exp(-1000) of the light is none.
    const LightPathCounts inky = traced_down(
        {support::horizontal("ink", 1, 1, true,
                             support::glass(1.33F, 1, Spectrum(Spectrum::Constant(1000)))),
         support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))},
        {});
    EXPECT_EQ(inky.stored, 0U);
    EXPECT_EQ(inky.absorbed, inky.refracted);
    EXPECT_EQ(inky.escaped, inky.reflected);
    // Fresnel's share straight on.
    const double reflectance = std::pow(0.33 / 2.33, 2);
    EXPECT_NEAR(static_cast<double>(inky.reflected), reflectance * whole_paths,
                chance_of(reflectance));
}

TEST(WholePath, EndsOnABlackSide) {
    const LightPathCounts behind =
        traced_down({support::horizontal("floor", 0, 1, false, support::diffuse(0.5F))}, {});
    EXPECT_EQ(behind.on_black_side, whole_paths);
    EXPECT_EQ(behind.stored, 0U);
    const LightPathCounts nothing =
        traced_down({support::horizontal("roof", 5, 1, false, support::diffuse(0.5F))}, {});
    EXPECT_EQ(nothing.missed, whole_paths);
}

// Between two mirrors, and at the second of two receivers.
TEST(WholePath, EndsWhereItsSettingsSay) {
    const std::vector<Shape> mirrors = {
        support::horizontal("low", 0, 1, true, support::mirror()),
        support::horizontal("high", 5, 1, false, support::mirror())};
    const LightPathCounts between = traced_down(mirrors, {.max_bounces = 3});
    EXPECT_EQ(between.reflected, 3 * whole_paths);
    EXPECT_EQ(between.depth_limited, whole_paths);
    // All that a white floor scatters comes to the sky about it: there it ends, or half of it goes on, half of that again.
    const std::vector<Shape> room = {support::horizontal("floor", 0, 1, true, support::diffuse(1)),
                                     support::enclosure(10, support::diffuse(0.5F))};
    EXPECT_EQ(traced_down(room, {.diffuse_bounces = 1}).stored, whole_paths);
    EXPECT_EQ(traced_down(room, {.diffuse_bounces = 2}).stored, 2 * whole_paths);
    EXPECT_NEAR(static_cast<double>(traced_down(room, {.diffuse_bounces = 3}).stored),
                2.5 * whole_paths, chance_of(0.5));
}

// Nothing is absorbed in a white room: the path would not end, and the message says what to do.
TEST(WholePath, RefusesASceneThatKeepsItsLight) {
    EXPECT_NO_THROW(require_end(99'999));
    SceneDesc desc;
    desc.shapes = {support::enclosure(5, support::diffuse(1))};
    const Scene scene(std::move(desc));
    const LightParticle particle{{Vec3(0, 0, 3), -Vec3::UnitZ()}, Spectrum(Spectrum::Ones())};
    LightPathCounts counts;
    std::vector<Deposit> deposits;
    Rng rng(3, Stage::test, 0);
    try {
        trace_whole_path(scene, particle, {}, rng, counts, deposits);
        ADD_FAILURE() << "ended after " << deposits.size();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("a reflectance below 1"), std::string::npos);
    }
}

}  // namespace
}  // namespace caustics

#include "photonmap/photons/global_photons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "tests/support/build_scene.h"

namespace caustics::photonmap {
namespace {

std::string why_unsupported(SceneDesc desc) {
    const Scene scene(std::move(desc));
    try {
        trace_global(scene, {.photons = 10}, {});
    } catch (const UnsupportedScene& error) {
        return error.what();
    }
    return "traced";
}

TEST(GlobalPhotons, SayWhyThereAreNone) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))};
    EXPECT_NE(why_unsupported(desc).find("the scene has no light"), std::string::npos);
    desc.lights = {support::point_light({0, 0, 1}, 1)};
    EXPECT_EQ(why_unsupported(desc), "traced");
    // Light falls on a mirror and leaves; the floor is behind it.
    desc.shapes.push_back(support::horizontal("mirror", 0.5, 1, true, support::mirror()));
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    const std::string none = why_unsupported(desc);
    EXPECT_TRUE(none.ends_with(" light paths"))
        << none << ", of which fewer `photons` take no less";
    EXPECT_NE(none.find("no light fell on a diffuse surface in "), std::string::npos) << none;
}

// A quarter of all directions times cosines is in front of a flat lamp.
TEST(GlobalPhotons, CountPathsThatALampThinsOutAsEmitted) {
    SceneDesc desc;
    desc.shapes = {support::enclosure(2, support::diffuse(0.5F)),
                   support::horizontal("lamp", 0, 0.5, true, support::diffuse(0))};
    desc.shapes[1].radiance = Spectrum(Spectrum::Ones());
    const Scene scene(std::move(desc));
    const TracedPhotons photons = trace_global(scene, {.photons = 20'000}, {});
    const auto emitted = static_cast<double>(photons.counts.emitted);
    EXPECT_NEAR(static_cast<double>(photons.counts.aimed), emitted / 4,
                4 * std::sqrt(emitted * 0.25 * 0.75));
    // Each of the lamp's paths comes to the wall, half of them again, and so on.
    EXPECT_NEAR(static_cast<double>(photons.counts.stored + photons.counts.dropped), emitted / 2,
                0.05 * emitted);
}

// Few paths bring nearly all photons: those of a weak lamp in a white room, beside a strong one that shines on nothing. A pilot
// that saw too many of them plans too few paths; a tenth more, again and again, bring what is missing.
TEST(GlobalPhotons, AreAsManyAsAskedThoughThePilotHopedForMore) {
    SceneDesc desc;
    desc.shapes = {support::enclosure(1, support::diffuse(0.997F))};
    desc.lights = {support::point_light({0, 0, 0}, 1), support::point_light({0, 0, 5}, 32'000)};
    const Scene scene(std::move(desc));
    constexpr std::uint64_t wanted = 40'000;
    const auto rounds = [&](std::uint64_t seed) {
        int ends = 0;
        RunOptions options;
        options.seed = seed;
        options.progress = [&](double share) { ends += share == 1 ? 1 : 0; };
        const TracedPhotons photons = trace_global(scene, {.photons = wanted}, options);
        EXPECT_EQ(photons.store.size(), wanted);
        EXPECT_EQ(photons.counts.stored, wanted);
        return ends;
    };
    EXPECT_GT(rounds(1), 1);
    EXPECT_EQ(rounds(2), 1);
}

// Photons from diffuse surfaces are told from those of a light by their marks, which are taken off.
TEST(GlobalPhotons, AreTakenApartByWhereTheyComeFrom) {
    SceneDesc desc;
    desc.shapes = {support::enclosure(1, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 0}, 1)};
    const Scene scene(std::move(desc));
    TracedPhotons photons = trace_global(scene, {.photons = 10'000}, {});
    const PhotonStore indirect = take_indirect(photons.store);
    // Half of the light is reflected each time: one half of all arrivals is not the first.
    EXPECT_NEAR(static_cast<double>(indirect.size()), 5'000, 4 * std::sqrt(10'000.0));
    EXPECT_EQ(photons.store.size(), 10'000U);
    for (const PhotonStore* store : {&std::as_const(photons.store), &indirect})
        for (const Photon& photon : store->photons())
            EXPECT_EQ(photon.flags & from_diffuse_mark, 0);
}

}  // namespace
}  // namespace caustics::photonmap

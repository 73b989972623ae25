#include "photonmap/shadow/shadow_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "photonmap/shadow/shadow_photons.h"
#include "tests/support/build_scene.h"

namespace caustics::photonmap {
namespace {

using Seen = KnownShadows::Seen;

/// A floor of 2 m a side in the sun, and a board a little above its left half.
SceneDesc sunny_floor() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F)),
                   support::rectangle("board", {-0.5, 0, 0.5}, {0.5, 0, 0}, {0, 1, 0},
                                      support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    return desc;
}

Seen seen(const ShadowMap& map, const Scene& scene, double x) {
    const ReceiverPoint point = support::probe(scene, 0, {x, 0, 0}, Vec3d::UnitZ(), 0);
    GatherScratch scratch;
    return map.sees(point, 0, scratch);
}

TEST(ShadowMap, TellsLightFromShadowAndNotAtTheEdge) {
    const Scene scene(sunny_floor());
    const ShadowMap map(scene, 20'000, {});
    for (const double x : {0.2, 0.5, 0.8}) {
        EXPECT_EQ(seen(map, scene, x), Seen::yes) << x;
        EXPECT_EQ(seen(map, scene, -x), Seen::no) << x;
    }
    EXPECT_EQ(seen(map, scene, 0), Seen::unknown);
    EXPECT_GE(map.bytes(), 20 * map.size());
}

// Of fewer photons than have to agree nothing is concluded.
TEST(ShadowMap, KnowsNothingWhereItHasFewPhotons) {
    const Scene scene(sunny_floor());
    const ShadowMap few(scene, 15, {});
    EXPECT_GT(few.size(), 0U);
    for (const double x : {-0.5, 0.5}) EXPECT_EQ(seen(few, scene, x), Seen::unknown) << x;
}

// Each light has photons of its own: the first shines below the board, the sun above it.
TEST(ShadowMap, AsksForEachLightByItself) {
    SceneDesc desc = sunny_floor();
    desc.lights.insert(desc.lights.begin(), support::point_light({-0.5, 0, 0.25}, 1));
    const Scene scene(std::move(desc));
    const ShadowMap map(scene, 20'000, {});
    const ReceiverPoint below = support::probe(scene, 0, {-0.5, 0, 0}, Vec3d::UnitZ(), 0);
    GatherScratch scratch;
    EXPECT_EQ(map.sees(below, 0, scratch), Seen::yes);
    EXPECT_EQ(map.sees(below, 1, scratch), Seen::no);
}

// A ray leaves a photon on each receiver that faces it: on 4 m^2 of the floor and 2 m^2 of the board, of the disc round the
// whole scene; what lies below the board is in shadow.
TEST(ShadowPhotons, LieOnEveryReceiverInTheRaysWay) {
    const Scene scene(sunny_floor());
    constexpr std::uint64_t paths = 40'000;
    const PhotonStore photons = trace_shadows(scene, 0, paths, {});
    std::array<double, 2> of_board{}, of_floor{};  // in shadow, in light
    for (const Photon& photon : photons.photons()) {
        const auto is_lit = lit(std::bit_cast<std::uint32_t>(photon.energy)) == Lit::yes ? 1U : 0U;
        (photon.position[2] > 0.25F ? of_board : of_floor)[is_lit] += 1;
        EXPECT_EQ(photon.flags & from_diffuse_mark, 0);
        if (photon.position[2] < 0.25F) {
            EXPECT_EQ(is_lit == 1, photon.position[0] > 0);
        }
    }
    const double disc = pi_d * (1 + 1 + 0.25 * 0.25);
    const double expected = paths * 2 / disc;
    const double chance = 4 * std::sqrt(expected * (1 - 2 / disc));
    EXPECT_EQ(of_board[0], 0);
    EXPECT_NEAR(of_board[1], expected, chance);
    EXPECT_EQ(of_floor[0], of_board[1]) << "the same rays";
    EXPECT_NEAR(of_floor[1], expected, chance);
}

// Half of a lamp's directions are below it, and by the cosine half of the others are left out.
TEST(ShadowPhotons, ComeFromTheFrontOfALampByTheCosine) {
    SceneDesc desc;
    desc.shapes = {support::enclosure(2, support::diffuse(0.5F)),
                   support::horizontal("lamp", 0, 0.5, true, support::diffuse(0))};
    desc.shapes[1].radiance = Spectrum(Spectrum::Ones());
    const Scene scene(std::move(desc));
    constexpr std::uint64_t paths = 40'000;
    const PhotonStore photons = trace_shadows(scene, 0, paths, {});
    EXPECT_NEAR(static_cast<double>(photons.size()), paths / 4.0,
                4 * std::sqrt(paths * 0.25 * 0.75));
    for (const Photon& photon : photons.photons()) EXPECT_GT(photon.position[2], 0);
}

// Sheets that face down are black where the light comes from above: they leave what lies below in shadow all the same. A ray
// ends at its 64th surface.
TEST(ShadowPhotons, PassBlackSidesAndEndAfterManySurfaces) {
    const auto stored = [](int sheets, bool up) {
        SceneDesc desc;
        desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))};
        for (int i = 1; i <= sheets; ++i)
            desc.shapes.push_back(
                support::horizontal("sheet", 0.01 * i, 1, up, support::diffuse(0.5F)));
        desc.lights = {support::directional_light({0, 0, -1}, 1)};
        const Scene scene(std::move(desc));
        return trace_shadows(scene, 0, 1'000, {});
    };
    const std::size_t rays = stored(0, true).size();
    EXPECT_GT(rays, 500U);
    const PhotonStore behind = stored(1, false);
    for (const Photon& photon : behind.photons()) {
        EXPECT_LT(photon.position[2], 0.005F);
        EXPECT_EQ(lit(std::bit_cast<std::uint32_t>(photon.energy)), Lit::no);
    }
    EXPECT_GT(behind.size(), 500U);
    const PhotonStore many = stored(80, true);
    std::size_t on_first = 0;
    float lowest = 1;
    for (const Photon& photon : many.photons()) {
        on_first += photon.position[2] > 0.795F ? 1U : 0U;
        lowest = std::min(lowest, photon.position[2]);
    }
    EXPECT_EQ(many.size(), 64 * on_first);
    EXPECT_NEAR(lowest, 0.80F - 63 * 0.01F, 1e-4F);
}

}  // namespace
}  // namespace caustics::photonmap

#include "photonmap/photons/scene_photons.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/sanitizers.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

using Emission = PhotonMapParams::Emission;

struct Mode {
    Emission emission;
    Interaction interaction;
};
constexpr Mode modes[] = {{Emission::random, Interaction::roulette},
                          {Emission::stratified, Interaction::roulette},
                          {Emission::random, Interaction::split},
                          {Emission::stratified, Interaction::split}};

PhotonMapParams params(const Mode& mode, std::uint64_t photons, std::uint64_t emitted = 0) {
    PhotonMapParams p;
    p.photons = photons;
    p.emitted = emitted;
    p.emission = mode.emission;
    p.interaction = mode.interaction;
    return p;
}

TracedPhotons trace(const Scene& scene, const PhotonMapParams& p, std::uint64_t seed = 1,
                    int threads = 1, Isa isa = widest_isa()) {
    RunOptions options;
    options.seed = seed;
    options.threads = threads;
    options.isa = isa;
    return trace_scene(scene, p, options);
}

/// The flux of all photons, mean of the channels [W].
double flux(const TracedPhotons& photons) {
    double sum = 0;
    for (const Photon& photon : photons.store.photons())
        sum += static_cast<double>(
            Spectrum(decode_rgbe(photon.energy) * photons.flux_per_energy()).mean());
    return sum;
}

Shape floor_under(double z) {
    return support::horizontal("floor", z, 6, true, support::diffuse(0.5F));
}

/// Waves of a mesh over a floor.
SceneDesc pool() {
    SineHeightfield field;
    field.waves = {{0.03, {7, 2}, 0.4}, {0.02, {-4, 9}, 2}};
    field.half_size = {1, 1};
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_heightfield(field, 16), Transform::Identity(),
                                 support::glass(1.33F, 1, Spectrum(0.4F, 0.1F, 0.05F))),
                   floor_under(-1)};
    return desc;
}

SceneDesc pool_and_point() {
    SceneDesc desc = pool();
    desc.lights = {support::point_light({0.4, 0.3, 2.5}, 5)};
    return desc;
}

SceneDesc pool_and_sun() {
    SceneDesc desc = pool();
    desc.lights = {support::directional_light({0.3, -0.2, -1}, 2)};
    return desc;
}

/// A ball, a mesh and a mirror that overlap as seen from the lamp.
SceneDesc crowd_and_lamp() {
    SceneDesc desc;
    desc.shapes = {
        floor_under(-1.2), support::sphere("ball", {0, 0, 0}, 0.6, support::glass(1.5F)),
        support::mesh("bubble", tessellate_sphere(8),
                      Transform(Eigen::Translation3d(0.3, 0.2, 1) * Eigen::Scaling(0.4)),
                      support::glass(1.3F)),
        support::rectangle("mirror", {-0.8, 0, 0.5}, {0, 0.6, 0}, {0, 0, 0.6},
                           support::mirror(0.8F)),
        support::rectangle("lamp", {0.5, 0.3, 2.5}, {0, 0.3, 0}, {0.3, 0, 0}, support::diffuse(0))};
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(8));
    return desc;
}

/// Two lights, one of them round.
SceneDesc ball_and_two_lights() {
    SceneDesc desc;
    desc.shapes = {floor_under(-1.2), support::sphere("ball", {0, 0, 0}, 0.8, support::glass(1.5F)),
                   support::sphere("lamp", {2, 1, 2}, 0.3, support::diffuse(0))};
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(9));
    desc.lights = {support::point_light({-1, 2, 2}, 3)};
    return desc;
}

using MakeScene = SceneDesc (*)();
constexpr MakeScene scenes[] = {pool_and_point, pool_and_sun, crowd_and_lamp, ball_and_two_lights};

TEST(ScenePhotons, AllWaysOfEmissionAgreeInFluxAndStrataScatterLess) {
    for (const MakeScene make : scenes) {
        const Scene scene(make());
        support::Moments moments[4];
        for (std::size_t mode = 0; mode < 4; ++mode)
            for (std::uint64_t seed = 0; seed < 24; ++seed)
                moments[mode].add(flux(trace(scene, params(modes[mode], 3'000), 100 + seed)));
        for (std::size_t mode = 1; mode < 4; ++mode) {
            const double error =
                std::hypot(moments[0].standard_error(), moments[mode].standard_error());
            EXPECT_NEAR(moments[mode].mean(), moments[0].mean(), 4 * error) << mode;
            EXPECT_LT(error, 0.01 * moments[0].mean());
        }
        EXPECT_LT(moments[3].deviation(), moments[2].deviation());
        if (make == pool_and_point || make == pool_and_sun) {
            EXPECT_LT(moments[1].deviation(), 0.5 * moments[0].deviation());
            EXPECT_LT(moments[3].deviation(), 0.3 * moments[0].deviation());
        }
    }
}

TEST(ScenePhotons, CountsAreExactAndEndsAddUp) {
    const Scene scene(crowd_and_lamp());
    for (const Mode& mode : modes) {
        for (const std::uint64_t wanted : {1U, 77U, 5'000U}) {
            const TracedPhotons photons = trace(scene, params(mode, wanted));
            EXPECT_EQ(photons.store.size(), wanted);
            EXPECT_EQ(photons.counts.stored, wanted);
            const LightPathCounts& c = photons.counts;
            EXPECT_EQ(c.missed + c.escaped + c.absorbed + c.misdirected + c.on_black_side +
                          c.depth_limited + c.stored + c.dropped,
                      c.aimed + c.branched);
            EXPECT_EQ(c.branched > 0, mode.interaction == Interaction::split);
        }
        for (const std::uint64_t emitted : {1U, 1'000U, 7'919U}) {
            const TracedPhotons photons = trace(scene, params(mode, 0, emitted));
            EXPECT_EQ(photons.counts.emitted, emitted);
            EXPECT_EQ(photons.counts.dropped, 0U);
        }
    }
}

TEST(ScenePhotons, AreTheSameBitForBitForAnyNumberOfThreads) {
    const Scene scene(crowd_and_lamp());
    for (const Mode& mode : modes)
        for (const PhotonMapParams& p : {params(mode, 30'000), params(mode, 0, 40'000)}) {
            const TracedPhotons one = trace(scene, p);
            for (const int threads : {2, 3}) {
                const TracedPhotons more = trace(scene, p, 1, threads);
                ASSERT_EQ(more.store.size(), one.store.size());
                EXPECT_EQ(more.counts.emitted, one.counts.emitted);
                EXPECT_EQ(more.counts.branched, one.counts.branched);
                EXPECT_EQ(std::memcmp(more.store.photons().data(), one.store.photons().data(),
                                      one.store.bytes()),
                          0);
            }
        }
}

TEST(ScenePhotons, AreTheSameBitForBitForEveryInstructionSet) {
    const Scene scene(crowd_and_lamp());
    for (const Mode& mode : modes) {
        const TracedPhotons plain = trace(scene, params(mode, 20'000), 1, 1, Isa::plain);
        for (const Isa isa : supported_isas()) {
            const TracedPhotons wide = trace(scene, params(mode, 20'000), 1, 1, isa);
            ASSERT_EQ(wide.store.size(), plain.store.size());
            EXPECT_EQ(wide.counts.emitted, plain.counts.emitted);
            EXPECT_EQ(std::memcmp(wide.store.photons().data(), plain.store.photons().data(),
                                  plain.store.bytes()),
                      0)
                << name(isa);
        }
    }
}

TEST(ScenePhotons, DepthLimitsAreCounted) {
    const Scene scene(crowd_and_lamp());
    for (const Mode& mode : modes) {
        PhotonMapParams p = params(mode, 0, 20'000);
        p.max_bounces = 1;
        EXPECT_GT(trace(scene, p).counts.depth_limited, 1'000U);
        p.max_bounces = 1'000;
        // But for a few that smooth normals on the bubble's facets hold inside by total reflection.
        EXPECT_LE(trace(scene, p).counts.depth_limited, 10U);
    }
}

TEST(ScenePhotons, GivesUpWhereNothingArrives) {
    SceneDesc desc = pool_and_point();
    desc.shapes.pop_back();
    const Scene scene(std::move(desc));
    Mode mode{Emission::random, Interaction::split};
    EXPECT_EQ(trace(scene, params(mode, 0, 1'000)).store.size(), 0U);
    SceneDesc no_caster;
    no_caster.shapes = {floor_under(0)};
    no_caster.lights = {support::point_light({0, 0, 1}, 1)};
    EXPECT_THROW(trace(Scene(std::move(no_caster)), params(mode, 10)), UnsupportedScene);
}

/// The sun on a mirror below a roof; few of the particles are reflected, or none where a lid is in the way.
SceneDesc dull_mirror(float reflectance, bool with_lid = false) {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("mirror", 0, 1, true, support::mirror(reflectance)),
        support::rectangle("roof", {0, 5, 1}, {5, 0, 0}, {0, -5, 0}, support::diffuse(0.5F))};
    if (with_lid)
        desc.shapes.push_back(
            support::rectangle("lid", {0, -1.5, 0.5}, {2, 0, 0}, {0, 2, 0}, support::diffuse(0)));
    desc.lights = {support::directional_light({0, 3, -1}, 1)};
    return desc;
}

std::string refusal_of_tracing(const Scene& scene, const PhotonMapParams& p,
                               std::uint64_t seed = 1) {
    try {
        trace(scene, p, seed);
    } catch (const UnsupportedScene& error) {
        return error.what();
    }
    return "traced";
}

// Two million paths are patience enough for a first photon.
TEST(ScenePhotons, GiveUpWhereNoPathArrivesAtAll) {
    const Scene scene(dull_mirror(1, true));
    // The pilot's last part is just beyond that.
    const std::string message = refusal_of_tracing(scene, params(modes[1], 1'000'448));
    EXPECT_NE(message.find("no photon can be stored: no light path met a caster"),
              std::string::npos)
        << message;
}

// One in some 3,000 paths arrives: few photons can be had, many would take more than fifty million paths.
TEST(ScenePhotons, GiveUpWhereFewPathsArriveAndManyPhotonsAreAsked) {
    // The mirror has a fifth of the disc that the sun's rays are sent through.
    const Scene scene(dull_mirror(0.0017F));
    const std::string message = refusal_of_tracing(scene, params(modes[1], 20'000));
    EXPECT_NE(message.find("light paths stored only"), std::string::npos) << message;
    EXPECT_NE(message.find("of 20000 photons"), std::string::npos) << message;
    EXPECT_NE(message.find("`emitted`"), std::string::npos) << message;
    const TracedPhotons few = trace(scene, params(modes[1], 20));
    EXPECT_EQ(few.store.size(), 20U);
}

// Some eight of two million paths arrive, whose number says nothing of how many more are needed.
TEST(ScenePhotons, GiveUpWithoutAGuessWhereHardlyAnyPathArrives) {
    const Scene scene(dull_mirror(0.00002F));
    const std::string message = refusal_of_tracing(scene, params(modes[1], 10));
    EXPECT_NE(message.find(" photons, too few to tell how many more it takes: "), std::string::npos)
        << message;
    EXPECT_EQ(message.find("of 10 photons"), std::string::npos) << message;
    EXPECT_NE(message.find("`emitted`"), std::string::npos) << message;
}

// A later pass traces at once: of the scene above, two million paths would say that few photons come.
TEST(ScenePhotons, AreAskedForTheirYieldByTheFirstPassAlone) {
    const Scene scene(dull_mirror(0.00002F));
    PhotonMapParams one = params(modes[0], 1);
    one.radius = 0.1;
    EXPECT_THROW(trace_scene(scene, one, {}, AskYield::yes), UnsupportedScene);
    EXPECT_THROW(build_pass(scene, one, {}, 0), UnsupportedScene);
    EXPECT_EQ(trace_scene(scene, one, {}, AskYield::no).store.size(), 1U);
    EXPECT_NO_THROW(build_pass(scene, one, {}, 1));
}

// One in some two million paths arrives, so that a run of one seed meets it and a run of another does not.
TEST(ScenePhotons, AreRefusedForEverySeedAlikeWhereHardlyAnyPathArrives) {
    const Scene scene(dull_mirror(0.000003F));
    const std::string message = refusal_of_tracing(scene, params(modes[0], 10'000));
    EXPECT_NE(message.find("`emitted`"), std::string::npos) << message;
    for (const Mode& mode : {modes[0], modes[1]})
        for (const std::uint64_t seed : {2U, 3U})
            EXPECT_EQ(refusal_of_tracing(scene, params(mode, 10'000), seed), message) << seed;
}

// Light through a ball without an edge, n = 1, onto a floor under its one half: in strata that the middle does not cut the
// pilot's parts all store the same, one half, and so many paths are planned that exactly enough photons come. Where the middle
// cuts strata of the plan itself it may be fewer: then all is traced again with a tenth more paths.
TEST(ScenePhotons, OfStrataAreTracedAgainWhereTooFewCame) {
    SceneDesc desc;
    desc.shapes = {
        support::sphere("ball", {0, 0, 0}, 1, support::glass(1)),
        support::rectangle("floor", {2, 0, -2}, {2, 0, 0}, {0, 2, 0}, support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    const Scene scene(std::move(desc));
    constexpr std::uint64_t wanted = 49;
    int at_once = 0, again = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const TracedPhotons photons = trace(scene, params(modes[1], wanted), seed);
        EXPECT_EQ(photons.store.size(), wanted);
        EXPECT_EQ(photons.counts.stored, wanted);
        // 7 x 14 strata, of which the middle cuts 14: half of those store, up to chance.
        at_once += photons.counts.emitted == 98 ? 1 : 0;
        again += photons.counts.emitted == 108 ? 1 : 0;
    }
    EXPECT_GT(at_once, 10);
    EXPECT_GT(again, 5) << "two in five, by chance";
}

// Where surfaces mirror and scatter a path leaves several photons: as many as asked come all the same, and their flux is that
// of paths whose number was given.
TEST(ScenePhotons, AreAsManyAsAskedWherePathsLeaveSeveral) {
    Bsdf blend = support::diffuse(0.5F);
    blend.mirror = MirrorPart{0.5F, Spectrum(Spectrum::Ones())};
    SceneDesc desc;
    desc.shapes = {support::enclosure(2, blend),
                   support::sphere("ball", {0, 0, 0}, 0.5, support::glass(1.5F))};
    desc.lights = {support::point_light({0, 0, 1.2}, 1)};
    const Scene scene(std::move(desc));
    for (const Mode& mode : {modes[0], modes[2]}) {
        support::Moments exactly, planned;
        for (std::uint64_t seed = 1; seed <= 16; ++seed) {
            const TracedPhotons photons = trace(scene, params(mode, 500), seed);
            EXPECT_EQ(photons.store.size(), 500U);
            const LightPathCounts& c = photons.counts;
            EXPECT_GT(c.branched, 0U);
            EXPECT_EQ(c.missed + c.escaped + c.absorbed + c.misdirected + c.on_black_side +
                          c.depth_limited + c.stored + c.dropped,
                      c.aimed + c.branched);
            exactly.add(flux(photons));
            planned.add(flux(trace(scene, params(mode, 0, 500), 100 + seed)));
        }
        EXPECT_NEAR(exactly.mean(), planned.mean(),
                    4 * std::hypot(exactly.standard_error(), planned.standard_error()));
    }
}

/// Resident memory of this process [bytes].
double resident() {
    std::ifstream file("/proc/self/statm");
    double whole = 0, pages = 0;
    file >> whole >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

TEST(ScenePhotons, TakeNoMoreMemoryThanTheirBytes) {
    if (support::sanitized) GTEST_SKIP() << "a sanitizer's own memory grows as well";
    const Scene scene(pool_and_point());
    for (const Mode& mode : modes)
        for (const int threads : {1, 2}) {
            trace(scene, params(mode, 1'000), 1, threads);
            const double before = resident();
            const TracedPhotons photons = trace(scene, params(mode, 300'000), 1, threads);
            const double block = PhotonStore::block_photons * sizeof(Photon);
            EXPECT_LE(resident() - before,
                      1.05 * static_cast<double>(photons.store.bytes()) + threads * block);
        }
}

}  // namespace
}  // namespace caustics::photonmap

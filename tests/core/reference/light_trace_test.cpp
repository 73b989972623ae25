#include "core/reference/light_trace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/support/build_scene.h"
#include "tests/support/flat_pool.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

using namespace support::flat_pool;
using Emission = LightTraceParams::Emission;

Scene pool() {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("floor", -depth, 12, true, support::diffuse(0.5F)),
        support::horizontal("water", 0, 3, true, support::glass(static_cast<float>(index)))};
    desc.lights = {support::point_light({0, 0, height}, static_cast<float>(intensity))};
    desc.camera = support::camera({0, 0, -0.2}, {0, 0, -1}, {0, 1, 0}, 90, 12, 8);
    return Scene(std::move(desc));
}

/// Points of a circle of the floor.
std::vector<ReceiverPoint> ring(const Scene& scene, double r) {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 24; ++i) {
        const double angle = 2 * pi_d * i / 24;
        points.push_back(support::probe(scene, 0,
                                        {r * std::cos(angle), r * std::sin(angle), -depth},
                                        Vec3d::UnitZ(), 0, 0.12F));
    }
    return points;
}

std::vector<Estimate> gathered(const Scene& scene, Emission emission, std::uint64_t paths,
                               std::uint64_t seed, int threads = 1) {
    RunOptions options;
    options.seed = seed;
    options.threads = threads;
    return support::irradiance(*build(scene, {.paths = paths, .emission = emission}, options),
                               ring(scene, 1));
}

/// Of many seeds: the mean, how values scatter about it, and what standard errors say of that, each squared
/// and summed over the points.
struct Trials {
    support::Moments value;
    double scatter = 0, stated = 0;
};

Trials many(const Scene& scene, Emission emission) {
    constexpr int seeds = 60;
    std::vector<support::Moments> points(24);
    Trials trials;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto found = gathered(scene, emission, 20'011, static_cast<std::uint64_t>(seed));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto value = static_cast<double>(found[i].value.mean());
            points[i].add(value);
            trials.value.add(value);
            trials.stated += std::pow(static_cast<double>(found[i].standard_error[0]), 2) / seeds;
        }
    }
    for (const support::Moments& point : points) trials.scatter += std::pow(point.deviation(), 2);
    return trials;
}

// A number of paths that is no whole number of strata: some are random.
TEST(LightTrace, StatesTheScatterOfItsValuesForEveryEmission) {
    const Scene scene = pool();
    const double truth = floor_irradiance(1);
    double scatter[2];
    for (const Emission emission : {Emission::random, Emission::stratified}) {
        const Trials trials = many(scene, emission);
        // The disc's own mean differs from its middle's by a part in a thousand.
        EXPECT_NEAR(trials.value.mean() / truth, 1,
                    1e-3 + 4 * trials.value.standard_error() / truth);
        // 24 sums of 60 squares, the stated ones of three degrees of freedom.
        EXPECT_NEAR(trials.stated / trials.scatter, 1, 0.12);
        scatter[emission == Emission::stratified ? 1 : 0] = trials.scatter;
    }
    EXPECT_LT(scatter[1], 0.35 * scatter[0]);
}

// Paths that come to a disc again and again: of a lamp beside the wall of a sphere that is a mirror and diffuse, and
// of indirect light in a sphere of albedo 0.9.
TEST(LightTrace, StatesTheScatterWherePathsComeBackToADisc) {
    Bsdf both = support::diffuse(0.5F);
    both.mirror = MirrorPart{0.9F, Spectrum(Spectrum::Ones())};
    const auto inside_of = [](const Bsdf& wall, const Vec3d& lamp) {
        SceneDesc desc;
        desc.shapes = {support::enclosure(1, wall)};
        desc.lights = {support::point_light(lamp, 1)};
        return Scene(std::move(desc));
    };
    const Scene mirror = inside_of(both, {0.3, 0.2, 0.1});
    const Scene white = inside_of(support::diffuse(0.9F), {0, 0, 0});
    const auto check = [](const Scene& scene, const auto& make) {
        const std::vector<ReceiverPoint> wall = {
            support::probe(scene, 0, {1, 0, 0}, -Vec3d::UnitX(), 0, 0.6F)};
        support::Moments found;
        double stated = 0;
        constexpr int seeds = 200;
        for (int seed = 1; seed <= seeds; ++seed) {
            RunOptions options;
            options.seed = static_cast<std::uint64_t>(seed);
            const Estimate one = support::irradiance(*make(scene, options), wall).front();
            found.add(static_cast<double>(one.value[0]));
            stated += std::pow(static_cast<double>(one.standard_error[0]), 2) / seeds;
        }
        // The variance of 200 values is known to a tenth.
        EXPECT_NEAR(stated / std::pow(found.deviation(), 2), 1, 0.3);
    };
    check(mirror, [](const Scene& scene, const RunOptions& options) {
        return build(scene, LightTraceParams{.paths = 2000, .max_bounces = 64}, options);
    });
    check(white, [](const Scene& scene, const RunOptions& options) {
        IndirectLightTraceParams params;
        params.paths = 2000;
        return build(scene, params, options);
    });
}

// Where no path came the standard error is that of one path: three of these bound the truth as often as the rule of
// three says (95 %), and none states 0 for a lit point.
TEST(LightTrace, StatesTheErrorOfOnePathWhereNoneCame) {
    const Scene scene = pool();
    const double truth =
        static_cast<double>(gathered(scene, Emission::random, 4'000'000, 99)[0].value[0]);
    int empty = 0, bounded = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
        for (const Estimate& found : gathered(scene, Emission::random, 1000, seed)) {
            EXPECT_GT(found.standard_error[0], 0);
            if (found.value[0] > 0) continue;
            ++empty;
            if (truth <= 3 * static_cast<double>(found.standard_error[0])) ++bounded;
        }
    ASSERT_GT(empty, 10);
    EXPECT_GE(bounded, 0.95 * empty);
}

TEST(LightTrace, StatesNoErrorOnASideThatScattersNothing) {
    const Scene scene = pool();
    const auto method = build(scene, LightTraceParams{.paths = 10}, RunOptions{});
    ReceiverPoint below = ring(scene, 1)[0];
    below.geometric_normal = -below.geometric_normal;
    below.front = false;
    EXPECT_EQ(support::irradiance(*method, {below})[0].standard_error[0], 0);
}

TEST(LightTrace, StratifiedIsTheSameForAnyNumberOfThreads) {
    const Scene scene = pool();
    const auto one = gathered(scene, Emission::stratified, 50'000, 3);
    const auto three = gathered(scene, Emission::stratified, 50'000, 3, 3);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_TRUE((one[i].value == three[i].value).all());
        EXPECT_TRUE((one[i].standard_error == three[i].standard_error).all());
    }
}

TEST(LightTrace, StratifiedCountsItsPathsInACamerasLayer) {
    const Scene scene = pool();
    double mean[2];
    for (const Emission emission : {Emission::random, Emission::stratified}) {
        const RunOptions options;
        const auto layer =
            build(scene, {.paths = 100'003, .emission = emission}, options)->camera_layer(options);
        EXPECT_EQ(layer->counters.at("photons_emitted"), 100'003U);
        double sum = 0;
        for (const Spectrum& pixel : layer->radiance) sum += static_cast<double>(pixel.mean());
        mean[emission == Emission::stratified ? 1 : 0] = sum / 96;
    }
    // A tenth of the paths end in the picture.
    EXPECT_NEAR(mean[1] / mean[0], 1, 4 / std::sqrt(1e4));
}

TEST(LightTrace, StratifiedNeedsAPathInEachBatch) {
    const auto read = [](const std::string& json) {
        return lighttrace_method().read(JsonNode::parse_text(json, "params"));
    };
    EXPECT_EQ(read(R"({"paths": 4, "emission": "stratified"})").emission, Emission::stratified);
    EXPECT_EQ(read("{}").emission, Emission::random);
    EXPECT_THROW(read(R"({"paths": 3, "emission": "stratified"})"), InputError);
}

}  // namespace
}  // namespace caustics

#include "photonmap/photon_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/light_path/aimed_emission.h"
#include "photonmap/progressive.h"

namespace caustics::photonmap {
namespace {

constexpr double light_height = 1;
constexpr double ceiling_height = 2;
const Spectrum intensity(10, 5, 1);  ///< [W/sr]

Shape rectangle(const Transform& to_world, const Bsdf& bsdf) {
    Shape shape;
    shape.primitive = Primitive::rectangle;
    shape.to_world = to_world;
    shape.bsdf = bsdf;
    return shape;
}

/// A mirror [-1, 1]^2 on the ground, a point light 1 m above its centre, and a ceiling 2 m above
/// it that catches all reflected light.
SceneDesc flat_mirror(const Bsdf& ceiling) {
    SceneDesc desc;
    desc.shapes.push_back(rectangle(Transform::Identity(), {Conductor{}}));
    Transform above = Transform::Identity();
    above.translate(Vec3d(0, 0, ceiling_height));
    above.rotate(Eigen::AngleAxisd(pi_d, Vec3d::UnitX()));
    above.scale(4);
    desc.shapes.push_back(rectangle(above, ceiling));
    desc.lights.emplace_back(PointLight{Vec3(0, 0, light_height), intensity});
    return desc;
}

const Bsdf grey{Diffuse{}};

ReceiverPoint ceiling_point(const Bsdf& bsdf, float x, float y, const Vec3& wo = -Vec3::UnitZ()) {
    ReceiverPoint point;
    point.position = Vec3(x, y, ceiling_height);
    point.geometric_normal = point.shading_normal = -Vec3::UnitZ();
    point.wo = wo;
    point.uv = Vec2(0.5F, 0.5F);
    point.bsdf = &bsdf;
    return point;
}

RunOptions run(std::uint64_t seed, int threads) {
    RunOptions options;
    options.seed = seed;
    options.threads = threads;
    return options;
}

std::vector<ReceiverPoint> ceiling_grid() {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 23 * 23; ++i)
        points.push_back(ceiling_point(grey, -2 + 4 * (static_cast<float>(i % 23) + 0.5F) / 23,
                                       -2 + 4 * (static_cast<float>(i / 23) + 0.5F) / 23));
    return points;
}

std::vector<Estimate> irradiance(const CausticEstimator& map,
                                 const std::vector<ReceiverPoint>& points) {
    std::vector<Estimate> out(points.size());
    map.irradiance(points, out, *map.make_context());
    return out;
}

TEST(PhotonMap, StoresTheFluxThatTheMirrorCatches) {
    const Scene scene(flat_mirror(grey));
    const auto map = build(
        scene,
        {.photons = 0, .emitted = 100'000, .kernel = KernelKind::point, .tree = TreeKind::balanced},
        {});
    const BuildReport report = map->build_report();
    EXPECT_EQ(report.counters.at("photons_emitted"), 100'000U);
    const double share = static_cast<double>(report.counters.at("photons_stored")) / 100'000;
    const auto power = static_cast<double>(AimedEmission(scene).total_power()[0]);
    // A square of half side 1 seen from 1 m above its centre: 4 asin(1/2) sr.
    const double expected = static_cast<double>(intensity[0]) * 2 * pi_d / 3 / power;
    EXPECT_NEAR(share, expected, 4 * std::sqrt(expected * (1 - expected) / 100'000));
    EXPECT_EQ(report.bytes, 20 * report.counters.at("photons_stored"));
}

TEST(PhotonMap, IsTheSameBitForBitWithOneAndTwoThreadsAndAnotherWithAnotherSeed) {
    const Scene scene(flat_mirror(grey));
    const PhotonMapParams params{.photons = 20'000};
    const auto one = build(scene, params, run(5, 1));
    const auto two = build(scene, params, run(5, 2));
    const auto other = build(scene, params, run(6, 2));
    EXPECT_EQ(one->build_report().counters, two->build_report().counters);
    EXPECT_EQ(one->build_report().resolved, two->build_report().resolved);
    const auto points = ceiling_grid();
    const auto a = irradiance(*one, points), b = irradiance(*two, points),
               c = irradiance(*other, points);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_TRUE((a[i].value == b[i].value).all());
        changed += (a[i].value != c[i].value).any() ? 1 : 0;
    }
    EXPECT_GT(changed, points.size() / 2);
}

TEST(PhotonMap, WeighsPhotonsByTheBsdfOfTheirOwnDirections) {
    const Bsdf glossy{Schlick{Spectrum(Spectrum::Constant(0.8F)), 0.3F}};
    const Scene scene(flat_mirror(glossy));
    const auto map = build(scene, {.photons = 200'000}, {});
    for (const Vec3& towards : {Vec3(0.2F, 0.1F, -1), Vec3(-1, 0, -1), Vec3(1, 0.5F, -0.5F)}) {
        const ReceiverPoint point = ceiling_point(glossy, 1, 0.5F, towards.normalized());
        const std::vector<ReceiverPoint> points{point};
        std::vector<Estimate> radiance(1);
        map->radiance(points, radiance, *map->make_context());
        const Vec3 wi = (Vec3(0, 0, -light_height) - point.position).normalized();
        const Spectrum f = evaluate(glossy, point.uv, point.shading_normal, point.wo, wi);
        // Radiance and irradiance come from the same photons: what is left is the width of the
        // disc and the direction code.
        const Spectrum ratio = radiance[0].value / irradiance(*map, points)[0].value;
        EXPECT_NEAR(ratio[0] / f[0], 1, 0.03);
    }
}

TEST(PhotonMap, KeepsTheSidesOfAThinReceiverApart) {
    Bsdf both = grey;
    both.twosided = true;
    const Scene scene(flat_mirror(both));
    const auto map = build(scene, {.photons = 10'000}, {});
    ReceiverPoint point = ceiling_point(both, 0, 0);
    EXPECT_GT(irradiance(*map, {point})[0].value[0], 0);
    point.geometric_normal = Vec3::UnitZ();
    EXPECT_EQ(irradiance(*map, {point})[0].value[0], 0);
}

TEST(PhotonMap, CountsQueriesAndTellsItsPhasesAndRadius) {
    const Scene scene(flat_mirror(grey));
    std::vector<std::string> phases;
    RunOptions options;
    options.begin_phase = [&](std::string_view phase) { phases.emplace_back(phase); };
    const auto map = build(
        scene, {.photons = 10'000, .kernel = KernelKind::point, .nearest = 20, .max_radius = 0.5},
        options);
    EXPECT_EQ(phases, (std::vector<std::string>{"trace", "balance"}));
    EXPECT_EQ(map->build_report().resolved.at("max_radius"), 0.5);
    const auto context = map->make_context();
    const std::vector<ReceiverPoint> points{ceiling_point(grey, 0, 0), ceiling_point(grey, 9, 9)};
    std::vector<Estimate> out(2);
    map->irradiance(points, out, *context);
    Counters counters;
    context->add_to(counters);
    EXPECT_EQ(counters.at("gathers"), 2U);
    EXPECT_EQ(counters.at("gathered_photons"), 20U);
    EXPECT_EQ(counters.at("empty_gathers"), 1U);
    EXPECT_FALSE(counters.contains("nodes_visited"));
    EXPECT_GT(build(scene, {.photons = 10'000}, {})->build_report().resolved.at("max_radius"), 0);
}

TEST(PhotonMap, CountsTheNodesThatTheTreesOfThePaperVisit) {
    const Scene scene(flat_mirror(grey));
    for (const TreeKind tree : {TreeKind::balanced, TreeKind::unbalanced}) {
        const auto map =
            build(scene,
                  {.photons = 1'000, .kernel = KernelKind::point, .tree = tree, .nearest = 20}, {});
        const auto context = map->make_context();
        const std::vector<ReceiverPoint> points{ceiling_point(grey, 0, 0)};
        std::vector<Estimate> out(1);
        map->irradiance(points, out, *context);
        Counters counters;
        context->add_to(counters);
        EXPECT_GE(counters.at("nodes_visited"), counters.at("gathered_photons"));
        EXPECT_LE(counters.at("nodes_visited"), 1'000U);
    }
}

TEST(PhotonMap, TellsThePhaseOfThePhotonsWidths) {
    const Scene scene(flat_mirror(grey));
    std::vector<std::string> phases;
    std::vector<double> done;
    RunOptions options;
    options.begin_phase = [&](std::string_view phase) {
        phases.emplace_back(phase);
        done.clear();
    };
    options.progress = [&](double share) { done.push_back(share); };
    const auto map = build(scene, {.photons = 10'000}, options);
    EXPECT_EQ(phases, (std::vector<std::string>{"trace", "balance", "widths"}));
    ASSERT_FALSE(done.empty());
    EXPECT_TRUE(std::ranges::is_sorted(done));
    EXPECT_EQ(done.back(), 1);
    EXPECT_TRUE(map->asks_for_cells());
    EXPECT_FALSE(build(scene, {.photons = 10, .pixel_footprint = false}, {})->asks_for_cells());
    EXPECT_FALSE(build(scene, {.photons = 10, .footprint = 0.1F}, {})->asks_for_cells());
}

// Smaller and smaller discs of the photons' own, too.
TEST(PhotonMap, PassesDrawThePhotonsDiscsCloser) {
    const Scene scene(flat_mirror(grey));
    for (const double radius : {0.0, 0.3}) {
        std::vector<std::uint64_t> found;
        for (const int pass : {0, 3}) {
            const auto map = build_pass(
                scene, {.photons = 20'000, .nearest = 300, .radius = radius, .passes = 4}, {},
                pass);
            const auto context = map->make_context();
            const std::vector<ReceiverPoint> points{ceiling_point(grey, 0, 0)};
            std::vector<Estimate> out(1);
            map->irradiance(points, out, *context);
            Counters counters;
            context->add_to(counters);
            found.push_back(counters.at("gathered_photons"));
        }
        const auto ratio = static_cast<double>(found[1]) / static_cast<double>(found[0]);
        EXPECT_NEAR(ratio, pass_share(3), 4 / std::sqrt(static_cast<double>(found[1])));
    }
}

TEST(PhotonMap, GathersAllPhotonsWithinARadius) {
    const Scene scene(flat_mirror(grey));
    const auto map = build(scene, {.photons = 10'000, .radius = 0.5}, {});
    EXPECT_FALSE(map->build_report().resolved.contains("max_radius"));
    const auto context = map->make_context();
    const std::vector<ReceiverPoint> points{ceiling_point(grey, 0, 0)};
    std::vector<Estimate> out(1);
    map->irradiance(points, out, *context);
    Counters counters;
    context->add_to(counters);
    EXPECT_GT(counters.at("gathered_photons"), 300U);
    const std::vector<Estimate> nearest =
        irradiance(*build(scene, {.photons = 10'000, .nearest = 300}, {}), points);
    EXPECT_NEAR(out[0].value[0] / nearest[0].value[0], 1, 0.2);
}

TEST(PhotonMap, CountsThePhotonsThatAdaptiveUses) {
    const Scene scene(flat_mirror(grey));
    const auto map = build(
        scene, {.photons = 20'000, .kernel = KernelKind::point, .nearest = 100, .adaptive = true},
        {});
    const auto context = map->make_context();
    const auto points = ceiling_grid();
    std::vector<Estimate> out(points.size());
    map->irradiance(points, out, *context);
    Counters counters;
    context->add_to(counters);
    EXPECT_LT(counters.at("used_photons"), counters.at("gathered_photons"));
    EXPECT_GT(counters.at("used_photons"), counters.at("gathered_photons") / 3);
}

TEST(PhotonMap, PassesAreIndependentMapsWithSmallerDiscs) {
    const Scene scene(flat_mirror(grey));
    const PhotonMapParams params{.photons = 20'000,
                                 .kernel = KernelKind::point,
                                 .tree = TreeKind::balanced,
                                 .radius = 0.3,
                                 .passes = 4};
    const std::vector<ReceiverPoint> points{ceiling_point(grey, 0, 0)};
    std::vector<std::uint64_t> found;
    std::set<float> values;
    for (int pass = 0; pass < 4; ++pass) {
        const auto map = build_pass(scene, params, {}, pass);
        EXPECT_EQ(map->build_report().bytes, 400'000U);
        const auto context = map->make_context();
        std::vector<Estimate> out(1);
        map->irradiance(points, out, *context);
        values.insert(out[0].value[0]);
        Counters counters;
        context->add_to(counters);
        found.push_back(counters.at("gathered_photons"));
    }
    EXPECT_EQ(values.size(), 4U);
    const auto ratio = static_cast<double>(found[3]) / static_cast<double>(found[0]);
    EXPECT_NEAR(ratio, pass_share(3), 4 / std::sqrt(static_cast<double>(found[3])));
    EXPECT_EQ(irradiance(*build(scene, params, {}), points)[0].value[0],
              irradiance(*build_pass(scene, params, {}, 0), points)[0].value[0]);
}

TEST(PhotonMap, RefusesToStorePhotonsWhereNoneCanBe) {
    SceneDesc desc = flat_mirror(grey);
    desc.shapes.front().bsdf = grey;
    const Scene scene(std::move(desc));
    EXPECT_THROW(build(scene, {.photons = 100}, {}), UnsupportedScene);
    const auto map = build(scene, {.photons = 0, .emitted = 100}, {});
    EXPECT_EQ(map->build_report().counters.at("photons_stored"), 0U);
    EXPECT_TRUE(is_black(irradiance(*map, {ceiling_point(grey, 0, 0)})[0].value));
}

TEST(PhotonMap, RefusesParametersThatContradictEachOther) {
    const Scene scene(flat_mirror(grey));
    using Estimator = PhotonMapParams::Estimator;
    EXPECT_THROW(build(scene, {.photons = 10, .emitted = 10}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 0, .emitted = 0}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .nearest = 1}, {}), InputError);
    EXPECT_NO_THROW(build(
        scene,
        {.photons = 10, .kernel = KernelKind::point, .nearest = 1, .estimator = Estimator::raw},
        {}));
    EXPECT_THROW(build(scene, {.photons = 10, .tree = TreeKind::balanced}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .adaptive = true}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .estimator = Estimator::raw}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .max_radius = -1}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .radius = -1}, {}), InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .passes = 0}, {}), InputError);
    EXPECT_THROW(
        build(scene, {.photons = 10, .kernel = KernelKind::point, .adaptive = true, .radius = 1},
              {}),
        InputError);
    EXPECT_THROW(
        build(scene, {.photons = 10, .kernel = KernelKind::point, .nearest = 10, .adaptive = true},
              {}),
        InputError);
    EXPECT_THROW(build(scene, {.photons = 10, .max_radius = 1, .radius = 1}, {}), InputError);
    EXPECT_THROW(
        build(scene,
              {.photons = 10, .kernel = KernelKind::point, .nearest = 100'001, .adaptive = true},
              {}),
        InputError);
}

// One map has one file; a loaded one is there already.
TEST(PhotonMap, RefusesFilesForSeveralMapsAndAFileToWriteBesideOneToRead) {
    const Scene scene(flat_mirror(grey));
    EXPECT_THROW(
        build(scene, PhotonMapParams{.photons = 0, .save = "a.photons", .load = "b.photons"}, {}),
        InputError);
    EXPECT_THROW(build(scene, PhotonMapParams{.photons = 10, .passes = 2, .save = "a.photons"}, {}),
                 InputError);
    EXPECT_THROW(build(scene, PhotonMapParams{.photons = 0, .passes = 2, .load = "a.photons"}, {}),
                 InputError);
}

TEST(PhotonMap, RefusesASquareToAverageOverWhereThatHasNoMeaning) {
    const Scene scene(flat_mirror(grey));
    using Estimator = PhotonMapParams::Estimator;
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const PhotonMapParams good{.photons = 10, .kernel = KernelKind::point, .footprint = 0.1F};
    EXPECT_NO_THROW(build(scene, good, {}));
    const auto refused = [&](const auto& change) {
        PhotonMapParams params = good;
        change(params);
        EXPECT_THROW(build(scene, params, {}), InputError);
    };
    refused([&](PhotonMapParams& params) { params.footprint = -0.1F; });
    refused([&](PhotonMapParams& params) { params.footprint = nan; });
    refused([](PhotonMapParams& params) { params.adaptive = true; });
    refused([](PhotonMapParams& params) { params.estimator = Estimator::raw; });
    refused([](PhotonMapParams& params) {
        params.filter = FilterKind::gaussian;
        params.filter_alpha = 0.918;
    });
}

}  // namespace
}  // namespace caustics::photonmap

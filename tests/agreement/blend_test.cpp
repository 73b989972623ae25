#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/illumination_map/illumination_map.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/eye_path.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// Surfaces that are diffuse and specular: they scatter the light that comes to them, and reflect it.
constexpr float weight = 0.6F;
constexpr float reflectance = 0.9F;
constexpr double q = static_cast<double>(weight) * static_cast<double>(reflectance);
constexpr double wall = 0.8;
constexpr double blend_lamp = 10;

Bsdf blend(float diffuse = 0.5F) {
    Bsdf bsdf = support::diffuse(diffuse);
    bsdf.mirror = MirrorPart{weight, Spectrum(Spectrum::Constant(reflectance))};
    return bsdf;
}

// A room with a blend for its floor (z = 0), a mirror wall (x = 3) and a diffuse ceiling (z = 2).
Scene room() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("ceiling", 2, 4, false, support::diffuse(0.5F)),
                   support::horizontal("floor", 0, 4, true, blend()),
                   support::rectangle("wall", {3, 0, 1}, Vec3d(0, -4, 0), Vec3d(0, 0, 1),
                                      support::mirror(static_cast<float>(wall)))};
    desc.lights = {support::point_light({0, 0, 1}, static_cast<float>(blend_lamp))};
    return Scene(std::move(desc));
}

// Of the light's image by mirrors, on a horizontal plane.
double from_image(const Vec3d& image, const Vec3d& point) {
    const Vec3d way = image - point;
    return blend_lamp * std::abs(way.z()) / std::pow(way.norm(), 3);
}

struct Place {
    std::size_t shape;
    Vec3d point;
    Vec3d normal;
    double exact;
};

// Light comes to the ceiling by the floor, by the wall and by both; to the floor by the wall.
std::vector<Place> places() {
    std::vector<Place> all;
    for (const double x : {-1.0, 0.5, 1.5}) {
        const Vec3d above(x, 0.2, 2);
        all.push_back({0, above, -Vec3d::UnitZ(),
                       q * from_image({0, 0, -1}, above) + wall * from_image({6, 0, 1}, above) +
                           q * wall * from_image({6, 0, -1}, above)});
        const Vec3d below(x, -0.3, 0);
        all.push_back({1, below, Vec3d::UnitZ(), wall * from_image({6, 0, 1}, below)});
    }
    return all;
}

std::vector<ReceiverPoint> probes(const Scene& scene, float radius) {
    std::vector<ReceiverPoint> points;
    for (const Place& place : places()) {
        points.push_back(
            support::probe(scene, place.shape, place.point, place.normal, points.size(), radius));
        const Vec3 normal = place.normal.cast<float>();
        const auto hit = scene.intersect(Ray{points.back().position + 0.1F * normal, -normal});
        points.back().uv = hit->uv;
        points.back().shape = hit->shape;
    }
    return points;
}

TEST(Blend, LightGoesOnFromWhereItIsScattered) {
    const Scene scene = room();
    const std::vector<Place> all = places();
    const auto expect_near = [&](const CausticEstimator& method, double slack) {
        const std::vector<Estimate> found = support::irradiance(method, probes(scene, 0.15F));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double error = static_cast<double>(found[i].standard_error[1]);
            EXPECT_NEAR(static_cast<double>(found[i].value[1]), all[i].exact,
                        support::sidak_bound(all.size()) * error + slack * all[i].exact)
                << i;
            EXPECT_LT(error, 0.3 * all[i].exact);
        }
    };
    expect_near(*build(scene, LightTraceParams{.paths = 2'000'000}, RunOptions{}), 5e-3);
    beamtree::BeamTreeParams tree;
    tree.intensity = beamtree::Intensity::refined;
    expect_near(*build(scene, tree, RunOptions{}), 5e-3);
    beamtree::CausticPolygonsParams polygons;
    polygons.receiver_resolution = 2;
    polygons.mesh_resolution = 128;
    expect_near(*build(scene, polygons, RunOptions{}), 0.05);
    for (const auto interaction : {Interaction::roulette, Interaction::split})
        for (const auto emission : {photonmap::PhotonMapParams::Emission::random,
                                    photonmap::PhotonMapParams::Emission::stratified}) {
            photonmap::PhotonMapParams map;
            map.photons = 0;
            map.emitted = 1'000'000;
            map.interaction = interaction;
            map.emission = emission;
            map.radius = 0.15;
            expect_near(*build(scene, map, RunOptions{}), 0.16);
        }
    expect_near(
        *build(scene, IlluminationMapParams{.emitted = 2'000'000, .resolution = 24}, RunOptions{}),
        0.12);
}

TEST(Blend, AMapStoresAsManyPhotonsAsAreAskedFor) {
    const Scene scene = room();
    for (const auto emission : {photonmap::PhotonMapParams::Emission::random,
                                photonmap::PhotonMapParams::Emission::stratified}) {
        photonmap::PhotonMapParams map;
        map.photons = 20'000;
        map.emission = emission;
        const auto report = build(scene, map, RunOptions{})->build_report();
        EXPECT_EQ(report.counters.at("photons_stored"), 20'000U);
        const LightPathCounts n = light_path_counts(report.counters);
        EXPECT_EQ(n.missed + n.escaped + n.absorbed + n.misdirected + n.on_black_side +
                      n.depth_limited + n.stored + n.dropped,
                  n.aimed + n.branched);
        EXPECT_GT(n.branched, 0U);
    }
}

// A light at the middle of a sphere comes back to it again and again: q + q^2 + ... + q^M of what it is
// without mirrors, everywhere the same.
TEST(Blend, InASphereItIsAGeometricSeries) {
    constexpr double radius = 2;
    for (const int max_bounces : {1, 2, 5, 64}) {
        SceneDesc desc;
        desc.shapes = {support::enclosure(radius, blend())};
        desc.lights = {support::point_light({0, 0, 0}, static_cast<float>(blend_lamp))};
        const Scene scene(std::move(desc));
        const auto method = build(
            scene, LightTraceParams{.paths = 300'000, .max_bounces = max_bounces}, RunOptions{});
        const double series = q * (1 - std::pow(q, max_bounces)) / (1 - q);
        std::vector<ReceiverPoint> points;
        for (const Vec3d& direction :
             {Vec3d(0, 0, -1), Vec3d(0.6, 0, 0.8), Vec3d(-0.48, 0.64, 0.6)})
            points.push_back(
                support::probe(scene, 0, radius * direction, -direction, points.size(), 0.3F));
        for (const Estimate& found : support::irradiance(*method, points))
            // A disc that cuts a sphere holds a little more of it than its own area.
            EXPECT_NEAR(
                static_cast<double>(found.value[0]), blend_lamp / 4 * series,
                4.5 * static_cast<double>(found.standard_error[0]) + 0.01 * blend_lamp / 4 * series)
                << max_bounces;
    }
}

// Under a lamp that paths from the receiver meet.
TEST(Blend, PathsFromTheReceiverFindTheSame) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("ceiling", 2, 4, false, support::diffuse(0.5F)),
                   support::horizontal("floor", 0, 4, true, blend())};
    desc.shapes.push_back(support::horizontal("lamp", 1, 0.05, false, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(1000));
    const Scene scene(std::move(desc));
    const auto method = build(scene, PathTraceParams{.spp = 4'000'000}, RunOptions{});
    const ReceiverPoint point = support::probe(scene, 0, {1, 0, 2}, -Vec3d::UnitZ(), 0);
    const Estimate found = support::irradiance(*method, {point})[0];
    // The lamp's image at z = -1 shines upwards: area x radiance x cosines / distance^2.
    const double exact = q * 1000 * 0.01 * 9 / 100;
    EXPECT_NEAR(static_cast<double>(found.value[2]), exact,
                4.5 * static_cast<double>(found.standard_error[2]) + 2e-3 * exact);
    EXPECT_LT(found.standard_error[2], 0.05 * exact);
}

TEST(Blend, TheEyeSeesTheSurfaceAndWhatItMirrors) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, blend()),
                   support::enclosure(20, support::diffuse(0))};
    desc.shapes[1].radiance = Spectrum(Spectrum::Constant(2));
    const Scene scene(std::move(desc));
    std::vector<WeightedPoint> points;
    Rng rng(1, Stage::test, 0);
    const EyePath path =
        trace_eye_path(scene, Ray{Vec3(0, 0, 1), -Vec3::UnitZ()}, black(), rng, points);
    EXPECT_NEAR(path.emitted[0], 2 * q, 1e-5);
    ASSERT_FALSE(points.empty());
    EXPECT_EQ(points[0].point.shape, 0U);
    EXPECT_EQ(points[0].weight[0], 1);
    const Spectrum f =
        evaluate(*points[0].point.bsdf, Vec2::Zero(), Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitZ());
    EXPECT_NEAR(f[0], 0.5F / pi * (1 - weight), 1e-6F);
}

// By the kernels of every instruction set the photons count with the share that is scattered.
TEST(Blend, PhotonsAreScatteredByTheShareThatIsNotMirrored) {
    const Scene scene = room();
    std::vector<ReceiverPoint> points = {support::probe(scene, 1, {0.5, 0, 0}, Vec3d::UnitZ(), 0)};
    photonmap::PhotonMapParams params;
    params.photons = 50'000;
    const auto map = build(scene, params, RunOptions{});
    const auto radiance = [&] {
        std::vector<Estimate> out(1);
        const auto context = map->make_context();
        map->radiance(points, out, *context);
        return static_cast<double>(out[0].value[0]);
    };
    const double blended = radiance();
    Bsdf plain = blend();
    plain.mirror.reset();
    points[0].bsdf = &plain;
    EXPECT_NEAR(blended / radiance(), 1 - static_cast<double>(weight), 1e-5);
}

}  // namespace
}  // namespace caustics

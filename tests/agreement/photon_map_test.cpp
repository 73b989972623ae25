#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/base/isa.h"
#include "core/render/renderer.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/light_flux.h"

namespace caustics {
namespace {

// Small versions of the three scenes, each with a point light and with an area light.
struct Case {
    std::string name;
    SceneDesc desc;
};

void add_light(SceneDesc& desc, const Vec3d& position, bool area) {
    if (!area) {
        desc.lights = {support::point_light(position, 10)};
        return;
    }
    Shape light = support::horizontal("light", 0, 0.15, false, support::diffuse(0));
    light.to_world = Eigen::Translation3d(position) * light.to_world;
    light.radiance = Spectrum(Spectrum::Constant(60));
    desc.shapes.push_back(light);
}

SceneDesc floor_seen_from(const Vec3d& eye, const Vec3d& target, double fov) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.camera = support::camera(eye, target, {0, 1, 0.1}, fov, 24, 24);
    return desc;
}

// The light on the ring's edge, where its caustic is a cardioid.
SceneDesc mirror_ring(bool area) {
    SceneDesc desc = floor_seen_from({0, 0, 5}, {0, 0, 0}, 26);
    Shape ring;
    ring.name = "ring";
    ring.primitive = Primitive::cylinder;
    ring.to_world = Eigen::Translation3d(0, 0, 0.01) * Eigen::Scaling(1.0, 1.0, 0.4);
    ring.bsdf = support::mirror();
    desc.shapes.push_back(ring);
    add_light(desc, {0.99, 0, 0.9}, area);
    return desc;
}

SceneDesc glass_ball(bool area) {
    SceneDesc desc = floor_seen_from({-1.5, -2, 2.5}, {-0.5, -0.3, 0}, 30);
    desc.shapes.push_back(support::sphere("ball", {0, 0, 0.55}, 0.5, support::glass(1.5F)));
    add_light(desc, {1.2, 1, 2.5}, area);
    return desc;
}

SceneDesc pool(bool area) {
    SceneDesc desc = floor_seen_from({0, 0, 0.95}, {0, 0, 0}, 80);
    Shape water;
    water.name = "water";
    water.primitive = Primitive::heightfield;
    water.field.half_size = Vec2d::Constant(2);
    water.field.waves = {{0.02, {5, 2}, 0.4}, {0.015, {-3, 6}, 1.3}};
    water.to_world = Eigen::Translation3d(0, 0, 1);
    water.bsdf = support::glass(1.333F);
    desc.shapes.push_back(water);
    add_light(desc, {0.3, 0.2, 3}, area);
    return desc;
}

std::vector<Case> all_cases() {
    return {{"mirror ring, point light", mirror_ring(false)},
            {"mirror ring, area light", mirror_ring(true)},
            {"glass ball, point light", glass_ball(false)},
            {"glass ball, area light", glass_ball(true)},
            {"pool, point light", pool(false)},
            {"pool, area light", pool(true)}};
}

// Flux of the map by its own counts against flux of particles sent without aim, within 1 %.
// 200,000 photons and as many unaimed arrivals are sure to 0.3 % and better.
TEST(PhotonMap, StoresTheReferencesFlux) {
    for (Case& one : all_cases()) {
        SCOPED_TRACE(one.name);
        const Scene scene(std::move(one.desc));
        photonmap::PhotonMapParams params;
        params.photons = 200'000;
        const BuildReport report = build(scene, params, RunOptions{})->build_report();
        const double stored = static_cast<double>(AimedEmission(scene).total_power()[1]) *
                              static_cast<double>(report.counters.at("photons_stored")) /
                              static_cast<double>(report.counters.at("photons_emitted"));
        const auto reference =
            support::flux_by_shape(scene, support::unaimed(scene, scene.lights()[0]), 1'500'000, 3);
        EXPECT_NEAR(stored / reference.total(), 1, 0.01);
    }
}

std::vector<float> greens(const Scene& scene, const photonmap::PhotonMapParams& params, Isa isa) {
    RunOptions options;
    options.threads = isa == Isa::plain ? 1 : 3;
    options.isa = isa;
    options.samples_per_pixel = 1;
    return *render(scene, *build(scene, params, options), options).film.find("caustic.G");
}

// Floors of every model that has a kernel, under every way to weigh photons.
TEST(PhotonMap, PicturesAreTheSameByThreadsAndInstructionSets) {
    std::vector<photonmap::PhotonMapParams> settings(
        5, {.photons = 5000, .kernel = photonmap::KernelKind::point});
    settings[1].filter = photonmap::FilterKind::cone;
    settings[2].footprint = 0.05F;
    settings[3].adaptive = true;
    settings[4].tree = photonmap::TreeKind::balanced;
    settings.push_back({.photons = 5000});
    settings.push_back(
        {.photons = 5000, .pixel_footprint = false, .filter = photonmap::FilterKind::epanechnikov});
    const Bsdf floors[] = {
        support::diffuse(0.5F), {Schlick{Spectrum(Spectrum::Constant(0.5F)), 0.1F}}, {Phong{}}};
    for (const Bsdf& floor : floors)
        for (Case& one : all_cases()) {
            SCOPED_TRACE(one.name);
            one.desc.shapes[0].bsdf = floor;
            const Scene scene(std::move(one.desc));
            for (const photonmap::PhotonMapParams& params : settings) {
                const std::vector<float> plain = greens(scene, params, Isa::plain);
                for (const Isa isa : supported_isas()) EXPECT_EQ(greens(scene, params, isa), plain);
            }
        }
}

}  // namespace
}  // namespace caustics

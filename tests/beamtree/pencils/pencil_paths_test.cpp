#include "beamtree/pencils/pencil_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "beamtree/beam_plan.h"
#include "beamtree/beam_tree.h"
#include "beamtree/pencils/light_patch.h"
#include "beamtree/pencils/pencil_map.h"
#include "core/light_path/ray_change.h"
#include "tests/beamtree/beam_scenes.h"
#include "tests/support/light_flux.h"

namespace caustics::beamtree {
namespace {

TracedPencils traced(const Scene& scene, std::uint64_t count, int threads = 1) {
    RunOptions options;
    options.threads = threads;
    return trace_pencils(scene, whole_lamps(scene, sample_lights(scene, 1, 1)), {count}, options);
}

double flux_of(const TracedPencils& pencils) {
    double sum = 0;
    for (const PencilPrint& print : pencils.prints) sum += static_cast<double>(print.flux.mean());
    return sum;
}

/// Light that particles of the photon map's kind bring to all receivers [W], and its error.
std::pair<double, double> flux_of_particles(const Scene& scene) {
    const AimedEmission emission(scene);
    const support::ArrivedFlux all = support::arrived_flux(
        scene, support::aimed(emission), 400'000, 1, [](const Deposit&) { return 0; }, 7);
    return {all.mean[0], all.standard_error[0]};
}

void expect_the_flux_of_particles(const Scene& scene, double tolerance) {
    const auto [flux, error] = flux_of_particles(scene);
    ASSERT_GT(flux, 0);
    EXPECT_NEAR(flux_of(traced(scene, 100'000)) / flux, 1, tolerance + 4 * error / flux);
}

SceneDesc room_with(std::vector<Shape> shapes) {
    SceneDesc desc;
    desc.shapes = std::move(shapes);
    desc.shapes.push_back(support::enclosure(6, support::diffuse(0.5F)));
    return desc;
}

// Against differences of the laws themselves.
TEST(Pencils, BendAsTheLawsSay) {
    const Vec3d w = Vec3d(0.3, -0.2, 0.8).normalized();
    const Vec3d n = Vec3d(-0.1, 0.15, 0.9).normalized();
    const Vec3d by_w = w.cross(Vec3d(0.3, 0.5, -0.4));
    const Vec3d by_n = n.cross(Vec3d(-0.7, 0.2, 0.6));
    const double eta = 1.5;
    const auto bent = [&](double t, bool refracts) -> Vec3d {
        const Vec3d v = (w + t * by_w).normalized();
        const Vec3d m = (n + t * by_n).normalized();
        const double cosine = m.dot(v);
        if (!refracts) return 2 * cosine * m - v;
        const double inner = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
        return (cosine * m - v) / eta - inner * m;
    };
    for (const bool refracts : {false, true}) {
        SpecularBend bend{w, n, n.dot(w), refracts, eta};
        bend.inner = -bent(0, true).dot(n);
        const double step = 1e-5;
        const Vec3d difference = (bent(step, refracts) - bent(-step, refracts)) / (2 * step);
        EXPECT_LT((bend.direction_change(by_w, by_n) - difference).norm(), 1e-8) << refracts;
    }
}

// A mirror's floor is lit as by a lamp behind the mirror: cosine over squared distance, at points as over squares.
TEST(Pencils, LightWhatAMirrorLightsAsItsImageDoes) {
    SceneDesc desc;
    desc.shapes = {
        support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, -1}, support::mirror()),
        support::horizontal("floor", 0, 4, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.2, -0.5, 1.2}, 3)};
    const Scene scene(std::move(desc));
    const Vec3d image(0.2, 2.5, 1.2);
    for (const float side : {0.0F, 0.01F}) {
        BeamTreeParams params;
        params.beam_events = 0;
        params.footprint = side;
        std::vector<ReceiverPoint> points;
        for (const double x : {-0.3, 0.1, 0.4})
            points.push_back(support::probe(scene, 1, {x, 0.3, 0}, Vec3d::UnitZ(), 0));
        const auto found = support::irradiance(*build(scene, params, {}), points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3d way = image - points[i].position.cast<double>();
            const double truth = 3 * way.z() / std::pow(way.norm(), 3);
            EXPECT_NEAR(static_cast<double>(found[i].value.mean()) / truth, 1, 0.01) << side;
        }
    }
}

// Behind balls, one before another, beside one and inside one: each caster's first light is its own.
TEST(Pencils, BringAllLightOnce) {
    const Bsdf glass = support::glass(1.5F);
    const std::vector<std::function<Light()>> lights = {
        [] { return support::point_light({-2, 0.3, 1}, 5); },
        [] { return support::point_light({-0.45, 0.1, 0}, 5); },
        [] { return support::point_light({0.1, 0.05, 0.1}, 5); },
        [] {
            SpotLight spot;
            spot.position = {-2, 0, 0};
            spot.intensity = Spectrum::Constant(5);
            spot.cone.axis = Vec3::UnitX();
            spot.cone.cutoff = 0.05F;
            return spot;
        }};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        SCOPED_TRACE(i);
        SceneDesc desc = room_with({support::sphere("near", {0, 0, 0}, 0.4, glass),
                                    support::sphere("far", {1.2, 0.1, -0.2}, 0.5, glass)});
        desc.lights = {lights[i]()};
        expect_the_flux_of_particles(Scene(std::move(desc)), 0.01);
    }
}

// From far away, onto a floor.
TEST(Pencils, BringAllDirectionalLight) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 1}, 0.4, support::glass(1.5F)),
                   support::sphere("above", {0.1, 0, 2}, 0.3, support::glass(1.5F)),
                   support::horizontal("floor", 0, 40, true, support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0.1, 0.2, -1}, 2)};
    expect_the_flux_of_particles(Scene(std::move(desc)), 0.01);
}

// Lamps that see balls from afar, whose plane goes through a ball, that touch the box of one, and round one; flat, curved and of triangles.
TEST(Pencils, BringAllLightOfLamps) {
    const Bsdf black = support::diffuse(0);
    const Transform beside(Eigen::Translation3d(-1, 0.4, 0.9) * Eigen::Scaling(0.3));
    const std::vector<std::function<Shape()>> lamps = {
        [&] { return support::horizontal("lamp", 2, 0.5, false, black); },
        [&] { return support::rectangle("lamp", {1, 0.7, 0.1}, {0.2, 0, 0}, {0, 0.2, 0}, black); },
        [&] { return support::horizontal("lamp", 0.42, 0.3, false, black); },
        [&] { return support::sphere("lamp", {-1, 0.4, 0.9}, 0.3, black); },
        [&] { return support::mesh("lamp", tessellate_sphere(8), beside, black); }};
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        SCOPED_TRACE(i);
        const Bsdf glass = support::glass(1.5F);
        SceneDesc desc = room_with({support::sphere("near", {0, 0, 0}, 0.4, glass),
                                    support::sphere("far", {1.2, 0.1, -0.8}, 0.5, glass)});
        desc.shapes.push_back(lamps[i]());
        desc.shapes.back().radiance = Spectrum(Spectrum::Constant(5));
        expect_the_flux_of_particles(Scene(std::move(desc)), 0.01);
    }
}

// Facets, and light of many events.
TEST(Pencils, BringTheLightOfAGem) {
    SceneDesc desc = room_with({support::mesh(
        "cube", support::flat(tessellate_cube(1)),
        Transform(Eigen::AngleAxisd(0.6, Vec3d(1, 2, 3).normalized())), support::glass(2.4F))});
    desc.lights = {support::point_light({3, 0.4, 2}, 5)};
    expect_the_flux_of_particles(Scene(std::move(desc)), 0.01);
}

// A print has all of its light on cells that tile its surroundings, however thin it is, and however it lies.
TEST(Pencils, KeepTheirLightOnCells) {
    for (const double thinness : {1.0, 0.1, 0.0}) {
        PencilPrint print{
            .position = {0.013F, -0.021F, 0},
            .normal = Vec3::UnitZ(),
            .wi = Vec3(0.6F, 0, 0.8F),
            .sides = {Vec3(0.2F, 0.1F, 0), Vec3(static_cast<float>(0.1 * thinness),
                                                static_cast<float>(-0.2 * thinness), 0)},
            .flux = Spectrum::Constant(2),
            .flat = true};
        const PencilMap map({print}, std::vector<LightSample>(1), Isa::plain, 1);
        double sum = 0;
        constexpr int cells = 40;
        constexpr double side = 0.5 / cells;
        std::vector<std::uint32_t> stack;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j) {
                ReceiverPoint point;
                point.position = Vec3(static_cast<float>((i + 0.5) * side - 0.25),
                                      static_cast<float>((j + 0.5) * side - 0.25), 0);
                point.geometric_normal = Vec3::UnitZ();
                const PixelCell cell = PixelCell::square(Vec3d::UnitZ(), side);
                point.cell = &cell;
                sum += static_cast<double>(map.irradiance(point, stack).mean()) * side * side;
            }
        EXPECT_NEAR(sum, 2, 1e-4) << thinness;
    }
}

// Pencils have what beams of few events leave, and nothing twice.
TEST(Pencils, ShareLightWithBeams) {
    SceneDesc desc = ball_desc(4);
    desc.shapes[0] = support::sphere("ball", {0, 0, 0.6}, 0.5, support::glass(1.5F));
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            points.push_back(
                support::probe(scene, 1, {0.1 * (i - 9.5), 0.1 * (j - 9.5), 0}, Vec3d::UnitZ(), 0));
    const auto mean = [&](BeamTreeParams params) {
        params.footprint = 0.1F;
        double sum = 0;
        for (const Estimate& one : support::irradiance(*build(scene, params, {}), points))
            sum += static_cast<double>(one.value.mean());
        return sum;
    };
    BeamTreeParams params;
    params.beam_events = 0;
    params.max_bounces = most_bounces;
    const double by_pencils = mean(params);
    for (const int few : {1, 2}) {
        params.beam_events = 0;
        params.max_bounces = few;
        const double few_by_pencils = mean(params);
        EXPECT_GT(few_by_pencils, 0);
        params.rest = BeamTreeParams::Rest::none;
        const double few_by_beams = mean(params);
        params.rest = BeamTreeParams::Rest::pencils;
        params.beam_events = few;
        params.max_bounces = most_bounces;
        EXPECT_NEAR((mean(params) - few_by_beams + few_by_pencils) / by_pencils, 1, 1e-3) << few;
        EXPECT_NEAR(few_by_beams / few_by_pencils, 1, 0.03) << few;
    }
}

TEST(Pencils, AreTheSameOnAnyNumberOfThreads) {
    SceneDesc desc = ball_desc(12);
    desc.shapes[0].bsdf = support::glass(1.5F);
    const Scene scene(std::move(desc));
    const TracedPencils one = traced(scene, 20'000, 1);
    const TracedPencils three = traced(scene, 20'000, 3);
    ASSERT_EQ(one.prints.size(), three.prints.size());
    for (std::size_t i = 0; i < one.prints.size(); ++i) {
        EXPECT_EQ(one.prints[i].position, three.prints[i].position);
        EXPECT_EQ(one.prints[i].sides, three.prints[i].sides);
        EXPECT_TRUE((one.prints[i].flux == three.prints[i].flux).all());
    }
}

// A pool's light is of one event and by beams; that of many facets, each cut by the next wall, by none.
TEST(BeamPlan, ChoosesByCostAndLight) {
    const RunOptions options;
    BeamTreeParams params;
    params.max_bounces = most_bounces;
    const BeamPlan pool = plan_beams(Scene(pool_desc(32)), params, options);
    EXPECT_GE(pool.beam_events, 1);
    EXPECT_FALSE(pool.needs_pencils);
    SceneDesc lamp = pool_desc(32);
    lamp.shapes.push_back(
        support::rectangle("lamp", {0.4, 0.3, 2.5}, {0, 0.1, 0}, {0.1, 0, 0}, support::diffuse(0)));
    lamp.shapes.back().radiance = Spectrum(Spectrum::Constant(20));
    lamp.lights.clear();
    EXPECT_EQ(plan_beams(Scene(std::move(lamp)), params, options).beam_events, 0);
    SceneDesc ball = ball_desc(128);
    ball.shapes[0].bsdf = support::glass(1.5F);
    const BeamPlan facets = plan_beams(Scene(std::move(ball)), params, options);
    EXPECT_EQ(facets.beam_events, 0);
    EXPECT_TRUE(facets.needs_pencils);
    params.beam_events = 3;
    EXPECT_EQ(plan_beams(Scene(pool_desc(32)), params, options).beam_events, 3);
    params.max_bounces = 2;
    EXPECT_EQ(plan_beams(Scene(pool_desc(32)), params, options).beam_events, 2);
}

// Whoever sees one event alone has no light of two.
TEST(BeamPlan, EndsAtTheLimitOfEvents) {
    SceneDesc desc = ball_desc(16);
    desc.shapes[0].bsdf = support::glass(1.5F);
    const Scene scene(std::move(desc));
    BeamTreeParams params;
    params.max_bounces = 1;
    for (const int beam_events : {0, 1}) {
        params.beam_events = beam_events;
        const BuildReport report = build(scene, params, {})->build_report();
        EXPECT_EQ(report.resolved.at("events_by_beams"), beam_events);
        EXPECT_EQ(report.resolved.at("beam_share"), beam_events);
    }
}

}  // namespace
}  // namespace caustics::beamtree

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "beamtree/tracing/beam_tracing.h"
#include "core/geometry/tessellate.h"
#include "core/light_path/aimed_emission.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/light_flux.h"
#include "tests/support/sanitizers.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

const Vec3d ball_centre(0, 0, 1.2);
constexpr double ball_radius = 0.5;
const Vec3d ball_lamp(0.3, -0.2, 4);

Shape floor_of(double half) {
    return support::horizontal("floor", 0, half, true, support::diffuse(0.5F));
}

SceneDesc over_a_floor(std::vector<Shape> casters, const Vec3d& lamp, float intensity = 10) {
    SceneDesc desc;
    desc.shapes = {floor_of(4)};
    for (Shape& caster : casters) desc.shapes.push_back(std::move(caster));
    desc.lights = {support::point_light(lamp, intensity)};
    return desc;
}

Shape ball_mesh(int resolution, const Bsdf& bsdf = support::glass(1.5F)) {
    return support::mesh("ball", tessellate_sphere(resolution),
                         Transform(Eigen::Translation3d(ball_centre) * Eigen::Scaling(ball_radius)),
                         bsdf);
}

beamtree::TracedBeams beams_of(const Scene& scene, int resolution, int max_bounces = 16) {
    return beamtree::trace_all_beams(scene, beamtree::caster_meshes(scene, resolution),
                                     beamtree::sample_lights(scene, 1, 1),
                                     {beamtree::Intensity::area, max_bounces}, {});
}

double flux_of(const beamtree::TracedBeams& traced, const std::vector<bool>& refracted) {
    double sum = 0;
    for (const beamtree::BeamSet& set : traced.sets) {
        bool same = set.path.size() == refracted.size();
        for (std::size_t i = 0; same && i < refracted.size(); ++i)
            same = set.path[i].refracted == refracted[i];
        for (const beamtree::Beam& beam : set.beams)
            if (same) sum += static_cast<double>(beam.flux.mean());
    }
    return sum;
}

// Of a point lamp's light by the angle from the ball's middle: Fresnel's shares along each ray, with
// `inner` reflections inside.
double flux_through_ball(double intensity, int inner) {
    const double distance = (ball_lamp - ball_centre).norm();
    const double limit = std::asin(ball_radius / distance);
    constexpr int steps = 20'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double angle = limit * (i + 0.5) / steps;
        const double sine = std::min(1.0, distance * std::sin(angle) / ball_radius);
        const double r = support::fresnel(std::sqrt(1 - sine * sine), 1.5);
        sum += 2 * pi_d * std::sin(angle) * (1 - r) * (1 - r) * std::pow(r, inner);
    }
    return intensity * sum * limit / steps;
}

// What goes through a ball, exact or a mesh, by two refractions, and what comes back after one reflection
// inside: above 99 % at a resolution of 64.
TEST(BeamBounces, CaptureTheFluxThroughABall) {
    for (const bool exact : {true, false}) {
        const Shape ball =
            exact ? support::sphere("ball", ball_centre, ball_radius, support::glass(1.5F))
                  : ball_mesh(64);
        const beamtree::TracedBeams traced =
            beams_of(Scene(over_a_floor({ball}, ball_lamp)), 64, 4);
        const double through = flux_of(traced, {true, true}) / flux_through_ball(10, 0);
        EXPECT_GT(through, 0.99) << exact;
        EXPECT_LT(through, 1.002);
        EXPECT_NEAR(flux_of(traced, {true, false, true}) / flux_through_ball(10, 1), 1, 0.02);
        EXPECT_GT(traced.balance.captured(), 0.99);
    }
}

// Neighbours on the first surface share their rays after every event, to the bit; corners where parts are cut have their own.
TEST(BeamBounces, NeighboursShareTheirRays) {
    const beamtree::TracedBeams traced =
        beams_of(Scene(over_a_floor({ball_mesh(32)}, ball_lamp)), 2, 3);
    for (const beamtree::BeamSet& set : traced.sets) {
        std::size_t corners = 0;
        for (const beamtree::Beam& beam : set.beams) corners += beam.triangle_count() + 2;
        EXPECT_LT(set.rays.size(), corners / 2) << set.path.size();
        for (const beamtree::VertexRay& ray : set.rays) {
            ASSERT_TRUE(ray.position.allFinite() && ray.direction.allFinite());
            ASSERT_NEAR(ray.direction.norm(), 1, 1e-5);
        }
    }
}

/// Water of waves that are so steep that they send half of the light of a lamp below them on to other waves.
Scene below_steep_water(double level, const Vec3d& lamp, double half_of_floor) {
    constexpr double half = 0.4;
    Shape water;
    water.name = "water";
    water.primitive = Primitive::heightfield;
    water.field.waves = {{0.032, Vec2d(19.8, 6.3), 0}};
    water.field.half_size = {half, half};
    water.to_world = Eigen::Translation3d(0, 0, level);
    water.bsdf = support::mirror();
    SceneDesc desc;
    desc.shapes = {water, floor_of(half_of_floor)};
    desc.shapes[0].bsdf.twosided = true;
    desc.lights = {support::point_light(lamp, 1)};
    return Scene(std::move(desc));
}

// The light that so many events send onto the floor, by the middles of beams.
double flux_of_events(const Scene& scene, int resolution, std::size_t events,
                      double half_of_floor) {
    const beamtree::TracedBeams traced = beamtree::trace_all_beams(
        scene, beamtree::caster_meshes(scene, resolution), beamtree::sample_lights(scene, 1, 1),
        {beamtree::Intensity::refined, static_cast<int>(events)}, {});
    double sum = 0;
    for (const beamtree::BeamSet& set : traced.sets) {
        if (set.path.size() != events) continue;
        for (const beamtree::Beam& beam : set.beams) {
            Vec3 position = Vec3::Zero(), direction = Vec3::Zero();
            for (std::size_t i = 0; i < 3; ++i) {
                position += set.rays[beam.corners[i]].position / 3;
                direction += set.rays[beam.corners[i]].direction;
            }
            const Vec3 lands = position - position.z() / direction.z() * direction;
            if (direction.z() < 0 &&
                static_cast<double>(lands.cwiseAbs().maxCoeff()) < half_of_floor)
                sum += static_cast<double>(beam.flux.mean());
        }
    }
    return sum;
}

// Chords of few polygons to a wave lie far off its surface: light that starts on them meets other waves than light of
// the surface does. A third of it was lost where there are six.
TEST(BeamBounces, FollowSteepWavesFromTheirSurface) {
    const Scene scene = below_steep_water(0.25, {-0.35, -0.3, 0.03}, 1);
    const double truth = flux_of_events(scene, 128, 2, 1);
    EXPECT_NEAR(flux_of_events(scene, 16, 2, 1) / truth, 1, 0.03);
    EXPECT_NEAR(flux_of_events(scene, 32, 2, 1) / truth, 1, 0.015);
}

// Waves that light meets at a low angle, by 3 polygons to a wave. More than half of the light of the third and of the
// fourth event was lost where only rays after the first event were asked how far they part.
TEST(BeamBounces, FollowFannedLightThroughThirdAndFourthEvents) {
    constexpr double half = 1.5;
    const Scene scene = below_steep_water(1.055, {-1.34, -1.15, 0.15}, half);
    const AimedEmission emission(scene);
    const auto truth = support::arrived_flux(
        scene, support::aimed(emission), 1'000'000, 5,
        [](const Deposit& d) { return d.bounces < 5 && d.front ? d.bounces : -1; }, 1);
    for (const std::size_t events : {3U, 4U})
        EXPECT_GT(flux_of_events(scene, 16, events, half), 0.72 * truth.mean[events]) << events;
}

constexpr int cells = 11;  // odd: the spots behind balls lie in the middle of one

/// Flux in cells of the floor's |x|, |y| <= half, of photons.
support::ArrivedFlux photon_cells(const Scene& scene, double half, std::uint64_t paths) {
    const AimedEmission emission(scene);
    return support::arrived_flux(
        scene, support::aimed(emission), paths, cells * cells,
        [half](const Deposit& deposit) {
            const Vec2d at = deposit.position.head<2>().cast<double>() / (2 * half);
            if (deposit.shape != 0 || at.cwiseAbs().maxCoeff() >= 0.5) return -1;
            return static_cast<int>(cells * (at.x() + 0.5)) +
                   cells * static_cast<int>(cells * (at.y() + 0.5));
        },
        3);
}

// As agreement/beam_picture_test, with all events on the way. `margin`: of the mean flux of a cell, what
// beams take as even over a polygon.
template <typename Params>
void expect_same_flux(const Scene& scene, double half, const Params& params, double margin) {
    const support::ArrivedFlux photons =
        photon_cells(scene, half, static_cast<std::uint64_t>(support::repetitions(500'000)));
    const auto method = build(scene, params, RunOptions{});
    const double side = 2 * half / cells;
    const double mean_flux = photons.total() / (cells * cells);
    double largest = 0;
    double total = 0;
    double variance = 0;
    for (int cell = 0; cell < cells * cells; ++cell) {
        const auto index = static_cast<std::size_t>(cell);
        Rng rng(9, Stage::test, index);
        support::Moments irradiance;
        std::vector<ReceiverPoint> points;
        const int n = support::sanitized ? 9 : 12;
        for (int i = 0; i < n * n; ++i) {
            const double u = (i % n + static_cast<double>(rng.next())) / n;
            const double v = (i / n + static_cast<double>(rng.next())) / n;
            const Vec3d p(side * (cell % cells + u) - half, side * (cell / cells + v) - half, 0);
            points.push_back(support::probe(scene, 0, p, Vec3d::UnitZ(), 0));
        }
        for (const Estimate& e : support::irradiance(*method, points))
            irradiance.add(static_cast<double>(e.value.mean()));
        const double area = side * side;
        const double error = std::sqrt(std::pow(photons.standard_error[index], 2) +
                                       std::pow(irradiance.standard_error() * area, 2) +
                                       std::pow(margin * mean_flux, 2));
        total += irradiance.mean() * area;
        variance += error * error;
        const double z = (irradiance.mean() * area - photons.mean[index]) / error;
        largest = std::max(largest, std::abs(z));
    }
    EXPECT_LT(largest, support::sidak_bound(cells * cells));
    EXPECT_NEAR(total, photons.total(), 4 * std::sqrt(variance) + 0.005 * photons.total());
}

beamtree::BeamTreeParams swept(beamtree::Intensity intensity = beamtree::Intensity::area) {
    beamtree::BeamTreeParams params = beamtree::BeamTreeParams::chuang1995();
    params.bound = beamtree::Bound::sphere_swept;
    params.intensity = intensity;
    return params;
}

TEST(BeamBounces, AgreeBehindAnExactGlassBall) {
    const Scene scene(over_a_floor(
        {support::sphere("ball", ball_centre, ball_radius, support::glass(1.5F))}, ball_lamp));
    expect_same_flux(scene, 1, swept(), 0.005);
}

TEST(BeamBounces, AgreeBehindABallOfTriangles) {
    expect_same_flux(Scene(over_a_floor({ball_mesh(48)}, ball_lamp)), 1,
                     swept(beamtree::Intensity::refined), 0.005);
}

// Facets, edges, total reflection: polygons are cut at each event.
TEST(BeamBounces, AgreeBehindAGlassCube) {
    const Transform place(Eigen::Translation3d(0, 0, 1) *
                          Eigen::AngleAxisd(0.6, Vec3d(1, 0.4, 0.2).normalized()) *
                          Eigen::Scaling(0.35));
    const Scene scene(over_a_floor(
        {support::mesh("cube", tessellate_cube(8), place, support::glass(1.5F))}, ball_lamp));
    expect_same_flux(scene, 1.5, swept(), 0.01);
}

TEST(BeamBounces, AgreeBehindTwoBallsOneHalfInTheShadeOfALid) {
    const Bsdf opaque = support::diffuse(0.5F, true);
    const Scene scene(
        over_a_floor({support::sphere("ball", ball_centre, ball_radius, support::glass(1.5F)),
                      support::sphere("second", {0.1, 0.1, 0.45}, 0.2, support::glass(1.33F)),
                      support::rectangle("lid", {0.6, 0, 2.5}, {0.5, 0, 0}, {0, 0.5, 0}, opaque)},
                     ball_lamp));
    expect_same_flux(scene, 1, swept(), 0.01);
}

TEST(BeamBounces, CausticPolygonsFollowThemToo) {
    const Scene scene(over_a_floor({ball_mesh(20)}, ball_lamp));
    beamtree::CausticPolygonsParams watt;
    watt.max_bounces = 3;
    beamtree::BeamTreeParams tree = swept();
    tree.max_bounces = 3;
    Rng rng(4, Stage::test, 0);
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 400; ++i) {
        const Vec3d p(2 * static_cast<double>(rng.next()) - 1,
                      2 * static_cast<double>(rng.next()) - 1, 0);
        points.push_back(support::probe(scene, 0, p, Vec3d::UnitZ(), 0));
    }
    const auto by_tree = support::irradiance(*build(scene, tree, {}), points);
    const auto by_polygons = support::irradiance(*build(scene, watt, {}), points);
    int different = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        different += std::abs(by_tree[i].value.mean() - by_polygons[i].value.mean()) >
                     1e-4F * by_tree[i].value.mean() + 1e-6F;
    EXPECT_LE(different, 4);
}

// A slab of glass that absorbs: all its inner reflections, by the closed form.
TEST(BeamBounces, AddUpToTheSeriesOfASlab) {
    const Bsdf bsdf = support::glass(1.5F, 1, Spectrum::Constant(4));
    SceneDesc desc;
    desc.shapes = {floor_of(4), support::horizontal("top", 1, 2, true, bsdf),
                   support::horizontal("bottom", 0.9, 2, false, bsdf)};
    desc.lights = {support::directional_light({0.5, 0, -std::sqrt(0.75)}, 1)};
    const Scene scene(std::move(desc));
    beamtree::BeamTreeParams params = swept();
    params.mesh_resolution = 8;
    const double cosine = std::sqrt(0.75);
    const double a = std::exp(-4 * 0.1 / support::refracted_cosine(cosine, 1.5));
    const double expected = cosine * support::slab(support::fresnel(cosine, 1.5), a).transmitted;
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(0.31, 0.17, 0)}) {
        const auto found = support::irradiance(*build(scene, params, {}),
                                               {support::probe(scene, 0, p, Vec3d::UnitZ(), 0)});
        EXPECT_NEAR(static_cast<double>(found[0].value.mean()) / expected, 1, 2e-3);
    }
}

// Where facets cut polygons along lines of symmetry, thin parts are left over: as bright as those beside them.
TEST(BeamBounces, LeaveNoDarkLinesBehindFlatGlass) {
    const Transform place(Eigen::Translation3d(0, 0, 1) * Eigen::Scaling(3.0, 3.0, 0.25));
    SceneDesc desc;
    desc.shapes = {floor_of(4),
                   support::mesh("pane", tessellate_cube(1), place, support::glass(1.5F))};
    desc.lights = {support::directional_light(Vec3d(0, 0.5, -1).normalized(), 1)};
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    for (int i = -18; i <= 18; ++i)
        for (const Vec3d& line : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(1, 1, 0)})
            points.push_back(
                support::probe(scene, 0, 0.05 * i * line, Vec3d::UnitZ(), points.size()));
    const double cosine = 1 / std::sqrt(1.25);
    const double expected = cosine * support::slab(support::fresnel(cosine, 1.5), 1).transmitted;
    for (const Estimate& found :
         support::irradiance(*build(scene, beamtree::BeamTreeParams(), {}), points))
        EXPECT_NEAR(static_cast<double>(found.value.mean()) / expected, 1, 0.005);
}

// Below a plane, a cap of radius 4 m whose facets turn by 0.14 degrees each: less than makes a crease, but three in a row are one.
TEST(BeamBounces, LoseNothingOnFacetsThatTurnByLittle) {
    const auto light_below = [](bool faceted) {
        TriangleMesh cap = tessellate_rectangle(200);
        for (std::size_t i = 0; i < cap.positions.size(); ++i) {
            Vec3& at = cap.positions[i];
            at.z() = at.head<2>().squaredNorm() / 8;
            cap.normals[i] = Vec3(-at.x() / 4, -at.y() / 4, 1).normalized();
        }
        flip(cap);
        if (faceted) cap.normals.clear();
        cap.patches.clear();
        const Transform place(Eigen::Translation3d(0, 0, 1));
        SceneDesc desc = over_a_floor(
            {support::mesh("top", tessellate_rectangle(16),
                           Transform(Eigen::Translation3d(0, 0, 1.4)), support::glass(1.5F)),
             support::mesh("cap", std::move(cap), place, support::glass(1.5F))},
            {0.05, 0.03, 2});
        const Scene scene(std::move(desc));
        beamtree::BeamTreeParams params;
        params.max_bounces = 2;
        std::vector<ReceiverPoint> points;
        for (int i = 0; i < 900; ++i)
            points.push_back(support::probe(scene, 0,
                                            {0.0301 * (i % 30) - 0.45, 0.0301 * (i / 30) - 0.45, 0},
                                            Vec3d::UnitZ(), 0));
        double sum = 0;
        for (const Estimate& found : support::irradiance(*build(scene, params, {}), points)) {
            EXPECT_GT(found.value.mean(), 0) << faceted;
            sum += static_cast<double>(found.value.mean());
        }
        return sum;
    };
    // Light behind facets is striped.
    EXPECT_NEAR(light_below(true) / light_below(false), 1, 0.02);
}

// A cube of water in a tilted one of flint: polygons of twelve triangles are too coarse for what they meet. The light
// of the floor's |x|, |y| <= 2.
TEST(BeamBounces, AreCompletedByPhotonsInACubeWithinACube) {
    const auto cube = [](const char* name, double size, double turn, const Bsdf& bsdf) {
        const Transform place(Eigen::Translation3d(0, 0, 1.2) *
                              Eigen::AngleAxisd(turn * pi_d / 180, Vec3d(1, 2, 3).normalized()) *
                              Eigen::Scaling(size));
        return support::mesh(name, tessellate_cube(1), place, bsdf);
    };
    SceneDesc desc;
    desc.shapes = {floor_of(4), cube("flint", 0.5, 37, support::glass(1.72F)),
                   cube("water", 0.3, 10, support::glass(1.333F, 1.72F))};
    desc.lights = {support::directional_light(Vec3d(0.3, 0.1, -1).normalized(), 1)};
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    const double by_particles =
        support::arrived_flux(
            scene, support::aimed(emission), 400'000, 1,
            [](const Deposit& deposit) {
                return deposit.shape == 0 && deposit.position.head<2>().cwiseAbs().maxCoeff() <= 2
                           ? 0
                           : -1;
            },
            7, beamtree::BeamTreeParams{}.max_bounces)
            .total();
    std::vector<ReceiverPoint> points;
    constexpr int side = 100;
    for (int i = 0; i < side * side; ++i)
        points.push_back(support::probe(
            scene, 0, {4 * (i % side + 0.5) / side - 2, 4 * (i / side + 0.5) / side - 2, 0},
            Vec3d::UnitZ(), 0));
    const auto share = [&](beamtree::BeamTreeParams::Rest rest) {
        beamtree::BeamTreeParams params;
        params.rest = rest;
        double sum = 0;
        for (const Estimate& found : support::irradiance(*build(scene, params, {}), points))
            sum += static_cast<double>(found.value.mean());
        return sum * 16 / (side * side) / by_particles;
    };
    EXPECT_LT(share(beamtree::BeamTreeParams::Rest::none), 0.95);
    EXPECT_NEAR(share(beamtree::BeamTreeParams::Rest::photons), 1, 0.015);
}

// Near the focus polygons leave the ball as slivers, whose planes do not lie along its surface: their light met the ball itself.
// The first two places were black.
TEST(BeamBounces, LeaveNoCracksBehindABall) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0.35}, 0.3, support::glass(1.5F)),
                   support::horizontal("floor", 0, 2, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({-1.2, 0.4, 1.6}, 6)};
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    const auto ask = [&](double x, double y) {
        points.push_back(support::probe(scene, 1, {x, y, 0}, Vec3d::UnitZ(), points.size()));
    };
    ask(0.4540, -0.0579);
    ask(0.4169, -0.2337);
    for (int i = 0; i < 60; ++i)
        for (int j = 0; j < 60; ++j) ask(0.3 + 0.0031 * i, -0.24 + 0.0037 * j);
    const auto found = support::irradiance(*build(scene, beamtree::BeamTreeParams(), {}), points);
    const auto dark =
        std::ranges::count_if(found, [](const Estimate& one) { return one.value.mean() < 0.1F; });
    EXPECT_EQ(dark, 0);
}

// Behind a ball under a lamp on its axis, at places that are alike by symmetry: on the planes of the mesh's edges, where
// beams that run sideways change the planes on which they are tested, and beside them.
TEST(BeamBounces, AreAlikeAllRoundABall) {
    SceneDesc desc;
    desc.shapes = {floor_of(1), support::sphere("ball", {0, 0, 0.6}, 0.3, support::glass(1.5F))};
    desc.lights = {support::point_light({0, 0, 2}, 1)};
    const Scene scene(std::move(desc));
    const auto method = build(scene, beamtree::BeamTreeParams(), {});
    for (const double radius : {0.37, 0.3818, 0.39, 0.396, 0.41, 0.42}) {
        std::vector<ReceiverPoint> points;
        for (int i = 0; i < 16; ++i) {
            const double angle = i * pi_d / 8;
            points.push_back(support::probe(scene, 0,
                                            {radius * std::cos(angle), radius * std::sin(angle), 0},
                                            Vec3d::UnitZ(), points.size()));
        }
        support::Moments all;
        const auto found = support::irradiance(*method, points);
        for (const Estimate& one : found) all.add(static_cast<double>(one.value.mean()));
        for (const Estimate& one : found)
            EXPECT_NEAR(static_cast<double>(one.value.mean()) / all.mean(), 1, 0.05) << radius;
    }
}

// Panes of glass thrown about, each of a few polygons: what the corners of one meet is seldom one pane.
TEST(BeamBounces, SayWhatTheyLose) {
    Rng rng(5, Stage::test, 0);
    const auto random = [&rng] {
        return Vec3d(2 * Vec3(rng.next(), rng.next(), rng.next()).cast<double>() - Vec3d::Ones());
    };
    std::vector<Shape> panes;
    for (int i = 0; i < 24; ++i) {
        const Vec3d u = random().normalized();
        const Vec3d v = u.cross(random()).normalized();
        panes.push_back(support::rectangle("pane" + std::to_string(i),
                                           Vec3d(0, 0, 0.9) + 0.4 * random(), 0.15 * u, 0.15 * v,
                                           support::glass(2.4F)));
    }
    const Scene scene(over_a_floor(std::move(panes), {0, 0, 3}));
    const beamtree::TracedBeams traced = beams_of(scene, 2, 4);
    EXPECT_LT(traced.balance.captured(), 0.995);
    EXPECT_GT(traced.balance.captured(), 0.5);
    EXPECT_LT(traced.balance.pruned, traced.balance.lost);
    EXPECT_EQ(beams_of(scene, 2, 1).balance.captured(), 1);
}

}  // namespace
}  // namespace caustics

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/material/wavelength.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/eye_path.h"
#include "experiments/gallery/meridian.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/flat_pool.h"
#include "tests/support/fresnel.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

constexpr double incidence = 60 * pi_d / 180;  // of light from far away on the face of a block
constexpr double depth = 1;                    // of the glass above the floor
constexpr double half_width = 0.1;             // of the face, along x
constexpr double half_length = 0.05;
constexpr double power = 10;  // W/m^2 across the light

// Far stronger than glass, so that the colours part widely: n = 1.73 to 1.83.
const Ior heavy = Ior::cauchy(1.69, 0.02);

Bsdf glass_of(const Ior& inside) {
    Bsdf bsdf = support::glass(1.5F);
    std::get<Dielectric>(bsdf.model).int_ior = inside;
    return bsdf;
}

SceneDesc block(const Ior& inside) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::rectangle("face", {0, 0, depth}, Vec3d(half_width, 0, 0),
                                      Vec3d(0, half_length, 0), glass_of(inside))};
    return desc;
}

Scene lit_from_far(const Ior& inside) {
    SceneDesc desc = block(inside);
    desc.lights = {support::directional_light({std::sin(incidence), 0, -std::cos(incidence)},
                                              static_cast<float>(power))};
    return Scene(std::move(desc));
}

// Irradiance of the floor at x: of the wavelengths whose shifted image of the face holds it.
SpectrumSum closed_form(double x) {
    constexpr int steps = 7'000;
    constexpr double width = (longest_wavelength - shortest_wavelength) / steps;
    SpectrumSum sum = SpectrumSum::Zero();
    for (int i = 0; i < steps; ++i) {
        const double nm = shortest_wavelength + width * (i + 0.5);
        const double n = heavy.at(static_cast<float>(nm));
        const double shift = depth * std::tan(std::asin(std::sin(incidence) / n));
        if (std::abs(x - shift) > half_width) continue;
        const double passed = 1 - support::fresnel(std::cos(incidence), n);
        sum += channel_density(nm) * (width * power * std::cos(incidence) * passed);
    }
    return sum;
}

// The same over a disc.
SpectrumSum closed_form(double x, double radius) {
    constexpr int steps = 100;
    SpectrumSum sum = SpectrumSum::Zero();
    double chords = 0;
    for (int i = 0; i < steps; ++i) {
        const double at = 2 * (i + 0.5) / steps - 1;
        const double chord = std::sqrt(1 - at * at);
        sum += closed_form(x + radius * at) * chord;
        chords += chord;
    }
    return sum / chords;
}

std::vector<ReceiverPoint> across(const Scene& scene, float radius) {
    std::vector<ReceiverPoint> points;
    std::uint64_t id = 0;
    for (const double x : {0.43, 0.45, 0.46, 0.475, 0.5, 0.55, 0.62, 0.645, 0.66, 0.675})
        points.push_back(support::probe(scene, 0, {x, 0, 0}, Vec3d::UnitZ(), id++, radius));
    return points;
}

double at(const ReceiverPoint& point) { return static_cast<double>(point.position.x()); }

TEST(Dispersion, LightTracingPaintsTheFringesOfAnImage) {
    const Scene scene = lit_from_far(heavy);
    const auto method = build(scene, LightTraceParams{.paths = 1'500'000}, RunOptions{});
    constexpr float radius = 0.005F;
    const std::vector<ReceiverPoint> points = across(scene, radius);
    const std::vector<Estimate> found = support::irradiance(*method, points);
    int coloured = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SpectrumSum exact = closed_form(at(points[i]), static_cast<double>(radius));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(found[i].value[c]), exact[c],
                        support::sidak_bound(3 * points.size()) *
                                static_cast<double>(found[i].standard_error[c]) +
                            1e-4 * power)
                << at(points[i]) << " " << c;
        coloured += exact.maxCoeff() > 1.5 * exact.minCoeff() ? 1 : 0;
    }
    EXPECT_GE(coloured, 4);
}

TEST(Dispersion, BeamsPaintThemToTheirNumberOfWavelengths) {
    const Scene scene = lit_from_far(heavy);
    const std::vector<ReceiverPoint> points = across(scene, 0);
    const auto expect_right = [&](const CausticEstimator& method, double slack) {
        const std::vector<Estimate> found = support::irradiance(method, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SpectrumSum exact = closed_form(at(points[i]));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(found[i].value[c]), exact[c],
                            slack * power * std::cos(incidence))
                    << at(points[i]) << " " << c;
        }
    };
    // A bin's weight is up to three times the channels' mean.
    beamtree::BeamTreeParams tree;
    tree.mesh_resolution = 4;
    tree.wavelengths = 512;
    expect_right(*build(scene, tree, RunOptions{}), 3.0 / 512);
    tree.intensity = beamtree::Intensity::refined;
    tree.wavelengths = 64;
    expect_right(*build(scene, tree, RunOptions{}), 3.0 / 64);
    beamtree::CausticPolygonsParams polygons;
    polygons.wavelengths = 64;
    polygons.receiver_resolution = 2;
    polygons.mesh_resolution = 4;
    expect_right(*build(scene, polygons, RunOptions{}), 3.0 / 64);
}

// Eight parts of the wavelengths stand for hundreds: what is left is that corners move linearly within one.
TEST(Dispersion, BeamsAskForTheIntervalsOfWavelengths) {
    const Scene scene = lit_from_far(heavy);
    const std::vector<ReceiverPoint> points = across(scene, 0);
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 4;
    params.wavelengths = 8;
    params.dispersion = beamtree::Dispersion::intervals;
    const auto expect_right = [&](const std::string& what) {
        const auto tree = build(scene, params, RunOptions{});
        const std::vector<Estimate> found = support::irradiance(*tree, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SpectrumSum exact = closed_form(at(points[i]));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(found[i].value[c]), exact[c],
                            0.003 * power * std::cos(incidence))
                    << what << " " << at(points[i]) << " " << c;
        }
        EXPECT_LT(tree->build_report().resolved.at("drift_bend"), 1e-3);
        EXPECT_EQ(tree->build_report().resolved.at("drift_unknown"), 0);
    };
    for (const beamtree::Bound bound : {beamtree::Bound::single, beamtree::Bound::double_cone,
                                        beamtree::Bound::hybrid, beamtree::Bound::sphere_swept}) {
        params.bound = bound;
        expect_right("bound " + std::to_string(static_cast<int>(bound)));
    }
    params.merging = beamtree::ConeTreeSettings::Merging::cones;
    expect_right("cones");
    params.merging = beamtree::ConeTreeSettings::Merging::rays;
    params.bound = beamtree::Bound::two_slice;
    params.leaf = beamtree::BeamTreeParams::Leaf::fixed;
    params.hierarchy = beamtree::BeamTreeParams::Tree::binned;
    expect_right("slices");
    params.intensity = beamtree::Intensity::refined;
    expect_right("refined");
    params.max_bounces = 1;
    expect_right("one event");
}

TEST(Dispersion, ThePhotonMapHasThemWithinItsBlur) {
    const Scene scene = lit_from_far(heavy);
    photonmap::PhotonMapParams params;
    params.photons = 400'000;
    params.radius = 0.005;
    for (const auto emission : {photonmap::PhotonMapParams::Emission::random,
                                photonmap::PhotonMapParams::Emission::stratified}) {
        params.emission = emission;
        const auto map = build(scene, params, RunOptions{});
        const std::vector<ReceiverPoint> points = across(scene, 0);
        const std::vector<Estimate> found = support::irradiance(*map, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SpectrumSum exact = closed_form(at(points[i]), params.radius);
            // Some 1500 photons lie in a disc of even light, with colours that scatter as much again.
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(found[i].value[c]), exact[c],
                            0.15 * std::sqrt(exact[c] * exact.maxCoeff()) + 0.02)
                    << at(points[i]) << " " << c;
        }
    }
}

// What the channels are of a value of the index of refraction.
template <typename OfIndex>
SpectrumSum over_wavelengths(const OfIndex& of_index) {
    constexpr int steps = 700;
    constexpr double width = (longest_wavelength - shortest_wavelength) / steps;
    SpectrumSum sum = SpectrumSum::Zero();
    for (int i = 0; i < steps; ++i) {
        const double nm = shortest_wavelength + width * (i + 0.5);
        sum += channel_density(nm) * (width * of_index(heavy.at(static_cast<float>(nm))));
    }
    return sum;
}

// The floor at distances from the axis by beams and by light tracing, over the closed form.
template <typename OfRadius>
void expect_on_rings(const Scene& scene, double floor, const std::vector<double>& radii,
                     const OfRadius& of_radius, const beamtree::BeamTreeParams& beams,
                     double slack) {
    const auto tree = build(scene, beams, RunOptions{});
    const auto light =
        build(scene, LightTraceParams{.paths = 1'000'000, .max_bounces = beams.max_bounces},
              RunOptions{});
    for (const double r : radii) {
        const SpectrumSum exact = over_wavelengths([&](double n) { return of_radius(r, n); });
        const auto point = [&](double turn, float disc) {
            return support::probe(scene, 0, {r * std::cos(turn), r * std::sin(turn), floor},
                                  Vec3d::UnitZ(), 0, disc);
        };
        const Spectrum found = support::irradiance(*tree, {point(0.3, 0)})[0].value;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(found[c]) / exact[c], 1, slack) << r << " " << c;
        // Discs side by side round the axis, which see different paths.
        constexpr int discs = 24;
        std::vector<ReceiverPoint> round;
        for (int i = 0; i < discs; ++i)
            round.push_back(point(2 * pi_d * i / discs, static_cast<float>(0.1 * r)));
        std::array<support::Moments, 3> means;
        for (const Estimate& e : support::irradiance(*light, round))
            for (std::size_t c = 0; c < 3; ++c)
                means[c].add(static_cast<double>(e.value[static_cast<Eigen::Index>(c)]));
        for (std::size_t c = 0; c < 3; ++c) {
            const double truth = exact[static_cast<Eigen::Index>(c)];
            EXPECT_NEAR(
                means[c].mean(), truth,
                support::sidak_bound(3 * radii.size()) * means[c].standard_error() + 0.01 * truth)
                << r << " " << c;
        }
    }
}

TEST(Dispersion, StillWaterIsTheClosedFormOverItsWavelengths) {
    namespace pool = support::flat_pool;
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -pool::depth, 12, true, support::diffuse(0.5F)),
                   support::horizontal("water", 0, 6, true, glass_of(heavy))};
    desc.lights = {support::point_light({0, 0, pool::height}, static_cast<float>(pool::intensity))};
    beamtree::BeamTreeParams beams;
    beams.mesh_resolution = 32;
    beams.intensity = beamtree::Intensity::refined;
    expect_on_rings(
        Scene(std::move(desc)), -pool::depth, {0.5, 1.0, 2.0},
        [](double r, double n) { return pool::floor_irradiance(r, pool::height, n); }, beams, 1e-3);
}

constexpr double lamp_height = 3, ball_height = 0.7, ball_radius = 0.5;

// Where light that leaves the lamp at an angle from the axis comes to the floor through the ball.
std::optional<experiments::Landing> through_ball(double angle, double n) {
    const Vec2d centre(0, ball_height);
    experiments::PlaneRay ray{{0, lamp_height}, {std::sin(angle), -std::cos(angle)}};
    if (!ray.reach_circle(ball_height, ball_radius, true)) return {};
    ray.refract((ray.origin - centre) / ball_radius, n);
    ray.reach_circle(ball_height, ball_radius, false);
    if (!ray.refract((ray.origin - centre) / ball_radius, 1 / n) || !ray.reach_plane(0)) return {};
    return experiments::Landing{ray.origin.x(), ray.share};
}

double below_ball(double r, double n) {
    const experiments::Meridian light{
        [n](double angle) { return through_ball(angle, n); },
        [](double angle) { return 2 * pi_d * power * std::sin(angle); }, 0,
        std::asin(ball_radius / (lamp_height - ball_height))};
    return light.irradiance(r);
}

Scene ball_lens() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, ball_height}, ball_radius, glass_of(heavy))};
    desc.lights = {support::point_light({0, 0, lamp_height}, static_cast<float>(power))};
    return Scene(std::move(desc));
}

// Where the start of a beam moves along a chord of the ball as the wavelength does, the ball itself is in the way.
TEST(Dispersion, IntervalsOfWavelengthsLeaveABallLensItsLight) {
    const Scene scene = ball_lens();
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 96;
    params.max_bounces = 2;
    params.rest = beamtree::BeamTreeParams::Rest::none;
    params.dispersion = beamtree::Dispersion::intervals;
    for (const int wavelengths : {4, 16}) {
        params.wavelengths = wavelengths;
        const auto tree = build(scene, params, RunOptions{});
        for (const double r : {0.1, 0.15, 0.2}) {
            const SpectrumSum exact = over_wavelengths([&](double n) { return below_ball(r, n); });
            const ReceiverPoint point = support::probe(
                scene, 0, {r * std::cos(0.3), r * std::sin(0.3), 0}, Vec3d::UnitZ(), 0, 0);
            const Spectrum found = support::irradiance(*tree, {point})[0].value;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(found[c]) / exact[c], 1, 0.02)
                    << wavelengths << " " << r << " " << c;
        }
    }
}

TEST(Dispersion, ABallLensIsTheClosedFormOverItsWavelengths) {
    beamtree::BeamTreeParams beams;
    beams.mesh_resolution = 96;
    beams.max_bounces = 2;
    beams.rest = beamtree::BeamTreeParams::Rest::max_beams;
    beams.intensity = beamtree::Intensity::refined;
    expect_on_rings(ball_lens(), 0, {0.1, 0.15, 0.2}, below_ball, beams, 5e-3);
    // The fringes are there: blue light has gone through a stronger lens.
    const SpectrumSum edge = over_wavelengths([](double n) { return below_ball(0.1, n); });
    EXPECT_GT(edge.maxCoeff() / edge.minCoeff(), 1.05);
}

// Light from everywhere above, where each is asked in its own way.
TEST(Dispersion, PathsFromTheReceiverAndFromTheLightAgree) {
    SceneDesc desc = block(heavy);
    Shape lamp = support::rectangle("lamp", {-1.2, 0, 2}, Vec3d(0.3, 0, 0), Vec3d(0, -0.3, 0),
                                    support::diffuse(0));
    lamp.radiance = Spectrum(Spectrum::Constant(50));
    desc.shapes.push_back(std::move(lamp));
    const Scene scene(std::move(desc));
    const auto forward = build(scene, LightTraceParams{.paths = 3'000'000}, RunOptions{});
    const auto backward = build(scene, PathTraceParams{.spp = 20'000}, RunOptions{});
    std::vector<ReceiverPoint> points;
    for (const double x : {0.4, 0.45, 0.5, 0.55})
        points.push_back(support::probe(scene, 0, {x, 0, 0}, Vec3d::UnitZ(),
                                        static_cast<std::uint64_t>(1000 * x), 0.01F));
    const std::vector<Estimate> a = support::irradiance(*forward, points);
    const std::vector<Estimate> b = support::irradiance(*backward, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const auto value = static_cast<double>(b[i].value[c]);
            const double error = std::hypot(static_cast<double>(a[i].standard_error[c]),
                                            static_cast<double>(b[i].standard_error[c]));
            EXPECT_GT(value, 0.1);
            EXPECT_LT(error, 0.12 * value);
            EXPECT_NEAR(static_cast<double>(a[i].value[c]), value,
                        support::sidak_bound(12) * error + 0.01 * value)
                << at(points[i]) << " " << c;
        }
}

// The eye's light, straight down into the block: (1 - F(l)) / n(l)^2 of each wavelength.
TEST(Dispersion, TheEyeSeesTheMeanOverItsWavelengths) {
    const Scene scene = lit_from_far(heavy);
    constexpr int rays = 20'000;
    std::array<support::Moments, 3> found;
    for (int i = 0; i < rays; ++i) {
        std::vector<WeightedPoint> points;
        Rng rng(7, Stage::test, static_cast<std::uint64_t>(i));
        trace_eye_path(scene, Ray{Vec3(0, 0, 2), -Vec3::UnitZ()}, black(), rng, points);
        Spectrum sum = black();
        for (const WeightedPoint& point : points) {
            EXPECT_GT(point.point.nm, 0);
            sum += point.weight;
        }
        for (std::size_t c = 0; c < 3; ++c)
            found[c].add(static_cast<double>(sum[static_cast<Eigen::Index>(c)]));
    }
    SpectrumSum exact = SpectrumSum::Zero();
    for (double nm = 380.5; nm < 730; nm += 1) {
        const double n = heavy.at(static_cast<float>(nm));
        exact += channel_density(nm) * (1 - support::fresnel(1, n)) / (n * n);
    }
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c].mean(), exact[static_cast<Eigen::Index>(c)],
                    4.5 * found[c].standard_error() + 1e-4);
}

// A viewer behind glass that has chosen a wavelength sees the picture of that wavelength: white light of
// it, at the place of its image.
TEST(Dispersion, AnswersForTheWavelengthThatTheViewersGlassHasChosen) {
    const Scene scene = lit_from_far(heavy);
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 4;
    params.wavelengths = 256;
    const auto beams = build(scene, params, RunOptions{});
    for (const float nm : {420.0F, 550.0F, 650.0F}) {
        const double n = heavy.at(nm);
        const double shift = depth * std::tan(std::asin(std::sin(incidence) / n));
        const double exact =
            power * std::cos(incidence) * (1 - support::fresnel(std::cos(incidence), n));
        ReceiverPoint inside =
            support::probe(scene, 0, {shift + 0.95 * half_width, 0, 0}, Vec3d::UnitZ(), 0);
        ReceiverPoint outside =
            support::probe(scene, 0, {shift + 1.05 * half_width, 0, 0}, Vec3d::UnitZ(), 1);
        inside.nm = outside.nm = nm;
        const std::vector<Estimate> found = support::irradiance(*beams, {inside, outside});
        EXPECT_NEAR(static_cast<double>(found[0].value.maxCoeff()), exact, 2e-3 * exact) << nm;
        EXPECT_TRUE(is_black(found[1].value)) << nm;
    }
}

TEST(Dispersion, ALawWithoutItChangesNoBit) {
    const Scene plain = lit_from_far(1.5F);
    const Scene law = lit_from_far(Ior::cauchy(1.5, 0));
    const std::vector<ReceiverPoint> points = across(plain, 0.005F);
    const auto expect_same = [&](const auto& params) {
        const auto a = support::irradiance(*build(plain, params, RunOptions{}), points);
        const auto b = support::irradiance(*build(law, params, RunOptions{}), points);
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_TRUE((a[i].value == b[i].value).all()) << i;
    };
    expect_same(LightTraceParams{.paths = 20'000});
    photonmap::PhotonMapParams map;
    map.photons = 10'000;
    expect_same(map);
    expect_same(beamtree::BeamTreeParams{});
}

// Between parallel faces a colour goes on side by side with the others.
TEST(Dispersion, ASlabColoursNothingButItsRim) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -0.5, 3, true, support::diffuse(0.5F)),
                   support::horizontal("top", 0.2, 0.4, true, glass_of(heavy)),
                   support::horizontal("bottom", 0, 0.4, false, glass_of(heavy))};
    desc.lights = {support::directional_light({0.5, 0, -1}, 10)};
    const Scene scene(std::move(desc));
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 2;
    params.wavelengths = 64;
    const auto beams = build(scene, params, RunOptions{});
    // Light that comes in at the open side lands elsewhere.
    const ReceiverPoint middle = support::probe(scene, 0, {0.05, 0, -0.5}, Vec3d::UnitZ(), 0);
    const Spectrum value = support::irradiance(*beams, {middle})[0].value;
    const double cosine = 1 / std::sqrt(1.25);
    SpectrumSum exact = SpectrumSum::Zero();
    for (double nm = 380.5; nm < 730; nm += 1) {
        const double r = support::fresnel(cosine, heavy.at(static_cast<float>(nm)));
        exact += channel_density(nm) * 10 * cosine * support::slab(r).transmitted;
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(static_cast<double>(value[c]) / exact[c], 1, 1e-3) << c;
}

}  // namespace
}  // namespace caustics

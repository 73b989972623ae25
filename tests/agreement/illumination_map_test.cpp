#include "core/illumination_map/illumination_map.h"
#include "core/geometry/tessellate.h"
#include "core/method/none.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/geometry/exact_shape.h"
#include "core/light_path/aimed_emission.h"
#include "core/reference/light_trace.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// A mirror under slanting daylight of irradiance 2 across its direction, and beside it a small plate
// that faces down, wholly in the reflected light: a uniform field of 2 cos(45 degrees).
constexpr double daylight = 2;
const double uniform = daylight * std::sqrt(0.5);
constexpr double plate_half = 0.2;

SceneDesc daylight_scene(const Bsdf& plate) {
    SceneDesc desc;
    desc.shapes.push_back(
        support::rectangle("mirror", {-1, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, support::mirror()));
    desc.shapes.push_back(support::horizontal("plate", 1, plate_half, false, plate));
    desc.lights.push_back(support::directional_light({1, 0, -1}, daylight));
    return desc;
}

std::unique_ptr<const CausticEstimator> map_of(const Scene& scene,
                                               const IlluminationMapParams& params,
                                               int threads = 1) {
    RunOptions options;
    options.threads = threads;
    return build(scene, params, options);
}

ReceiverPoint on_shape(const Scene& scene, std::uint32_t shape, const Vec2& uv, bool front = true) {
    ReceiverPoint point;
    point.shape = shape;
    point.uv = uv;
    point.front = front;
    point.bsdf = &scene.shapes()[shape].bsdf;
    return point;
}

TEST(IlluminationMap, ReadsAUniformFieldWithoutBiasUpToTheEdges) {
    const Scene scene(daylight_scene(support::diffuse(0.5F)));
    const auto map = map_of(scene, {.emitted = 1'000'000, .resolution = 8});
    support::Moments middle, edge;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            const Vec2 uv((static_cast<float>(i) + 0.5F) / 40, (static_cast<float>(j) + 0.5F) / 40);
            const float inside = std::min(uv.minCoeff(), 1 - uv.maxCoeff());
            const auto e = support::irradiance(*map, {on_shape(scene, 1, uv)});
            (inside < 1.0F / 16 ? edge : middle).add(static_cast<double>(e[0].value[0]) / uniform);
        }
    // Some 70,000 photons arrive in all, 30,000 in the texels along the edge: three deviations.
    EXPECT_NEAR(middle.mean(), 1, 0.013);
    EXPECT_NEAR(edge.mean(), 1, 0.02);
}

TEST(IlluminationMap, FollowsAMirroredPointLight) {
    // By the method of images: E = I cos(theta) / d^2 from a point half a metre below the mirror.
    constexpr double intensity = 2, distance = 1.5, half = 0.3;
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", 0, 0.15, true, support::mirror()),
                   support::horizontal("plate", 1, half, false, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 0.5}, static_cast<float>(intensity))};
    const Scene scene(std::move(desc));
    const auto map = map_of(scene, {.emitted = 300'000, .resolution = 16});
    support::Moments middle, outside;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            const Vec2d uv((i + 0.5) / 40, (j + 0.5) / 40);
            const Vec2d off = half * (2 * uv - Vec2d::Ones());
            const double d = std::hypot(off.norm(), distance);
            const double expected = intensity * distance / (d * d * d);
            const auto e = support::irradiance(*map, {on_shape(scene, 1, uv.cast<float>())});
            (off.cwiseAbs().maxCoeff() < half / 2 ? middle : outside)
                .add(static_cast<double>(e[0].value[0]) / expected);
        }
    // Some 23,000 photons arrive in the middle, 70,000 outside: three deviations.
    EXPECT_NEAR(middle.mean(), 1, 0.02);
    EXPECT_NEAR(outside.mean(), 1, 0.012);
}

/// The flux that the map shows on a side of a shape: its irradiance over the surface, by three Gauss
/// points a half texel.
SpectrumSum shown_flux(const Scene& scene, const CausticEstimator& map, std::uint32_t shape,
                       int resolution) {
    constexpr double places[] = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
    constexpr double weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const double step = 0.5 / resolution;
    std::vector<ReceiverPoint> points;
    std::vector<double> areas;
    for (int row = 0; row < 2 * resolution; ++row)
        for (int column = 0; column < 2 * resolution; ++column)
            for (std::size_t i = 0; i < 9; ++i) {
                const Vec2d uv(step * (column + places[i % 3]), step * (row + places[i / 3]));
                points.push_back(on_shape(scene, shape, uv.cast<float>()));
                areas.push_back(weights[i % 3] * weights[i / 3] * step * step *
                                exact_area_element(scene.shapes()[shape], uv));
            }
    const auto seen = support::irradiance(map, points);
    SpectrumSum sum = SpectrumSum::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) sum += areas[i] * seen[i].value.cast<double>();
    return sum;
}

TEST(IlluminationMap, ShowsTheFluxThatArrives) {
    // A mirror ball sends a point's light to all sides of a receiver round it: seams and poles.
    std::vector<Shape> receivers(3);
    receivers[0] = support::sphere("round", {0.2, 0, 0}, 3, support::diffuse(0.5F));
    receivers[1].primitive = Primitive::cylinder;
    receivers[1].to_world = Eigen::Translation3d(0, 0, -1.5) * Eigen::Scaling(3.0);
    receivers[1].bsdf = support::diffuse(0.5F);
    receivers[2] = support::horizontal("disc", -1.5, 3, true, support::diffuse(0.5F));
    receivers[2].primitive = Primitive::disk;
    for (Shape& receiver : receivers) {
        receiver.flip_normals = &receiver != &receivers[2];
        SceneDesc desc;
        desc.shapes = {support::sphere("ball", {0, 0, 0}, 0.5, support::mirror()), receiver};
        desc.lights.push_back(support::point_light({1, 0.5, -0.7}, 5));
        const Scene scene(std::move(desc));
        const auto map = map_of(scene, {.emitted = 20'000, .resolution = 12});
        // Every particle has the same flux, and a perfect mirror keeps it.
        const auto stored = static_cast<double>(map->build_report().counters.at("photons_stored"));
        const double arrived =
            static_cast<double>(AimedEmission(scene).total_power()[0]) * stored / 20'000;
        EXPECT_GT(stored, 1000);
        EXPECT_NEAR(shown_flux(scene, *map, 1, 12)[0] / arrived, 1, 1e-6);
    }
}

/// A glass ball's caustic on a floor, and a camera.
SceneDesc glass_ball_scene() {
    SceneDesc desc;
    desc.shapes.push_back(support::sphere("ball", {0, 0, 0.6}, 0.5, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("floor", 0, 1.5, true, support::diffuse(0.5F)));
    desc.lights.push_back(support::point_light({-0.5, -0.4, 3}, 5));
    desc.camera = support::camera({1.5, -2, 1.5}, {0.2, 0.2, 0}, {0, 0, 1}, 40, 24, 18);
    return desc;
}

TEST(IlluminationMap, ShowsAsMuchFluxAsLightTracingGathers) {
    SceneDesc desc = glass_ball_scene();
    std::get<Dielectric>(desc.shapes[0].bsdf.model).absorption = Spectrum(0.1F, 1, 3);
    const Scene scene(std::move(desc));
    constexpr std::uint64_t paths = 100'000;
    const auto map = map_of(scene, {.emitted = paths, .resolution = 32});
    const auto tracing = build(scene, LightTraceParams{.paths = paths}, RunOptions{});
    // A disc that holds the whole floor.
    const float radius = 2.2F;
    const auto gathered = support::irradiance(
        *tracing, {support::probe(scene, 1, {0, 0, 0}, Vec3d::UnitZ(), 0, radius)});
    const double area = pi_d * static_cast<double>(radius * radius);
    const SpectrumSum shown = shown_flux(scene, *map, 1, 32);
    for (int channel = 0; channel < 3; ++channel) {
        const double flux = area * static_cast<double>(gathered[0].value[channel]);
        const double error = area * static_cast<double>(gathered[0].standard_error[channel]);
        EXPECT_NEAR(shown[channel], flux, 4 * std::sqrt(2.0) * error) << channel;
        EXPECT_LT(error, 0.01 * flux);
    }
}

double map_rmse(const Film& film, const Film& reference) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if ((*reference.find("unreached.Y"))[i] != 0) continue;
        const Spectrum difference = film.rgb("caustic", i) - reference.rgb("caustic", i);
        sum += difference.cast<double>().square().sum();
        count += 3;
    }
    return std::sqrt(sum / static_cast<double>(count));
}

TEST(IlluminationMap, ComesCloserToLightTracingAsTexelsShrink) {
    const Scene scene(glass_ball_scene());
    RunOptions options;
    options.samples_per_pixel = 16;
    const auto truth = build(scene, LightTraceParams{.paths = 400'000}, options);
    const Film reference = render(scene, *truth, options).film;
    const auto none = build(scene, NoneParams{}, options);
    double coarser = map_rmse(render(scene, *none, options).film, reference);
    for (const int resolution : {32, 128}) {
        const auto map = map_of(scene, {.emitted = 400'000, .resolution = resolution});
        const double error = map_rmse(render(scene, *map, options).film, reference);
        EXPECT_LT(error, 0.6 * coarser) << resolution;
        coarser = error;
    }
}

TEST(IlluminationMap, IsTheSameBitForBitOnAnyNumberOfThreads) {
    const Scene scene(glass_ball_scene());
    const IlluminationMapParams params{.emitted = 50'000, .resolution = 32};
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 64 * 64; ++i)
        points.push_back(
            on_shape(scene, 1, {static_cast<float>(i % 64) / 64, static_cast<float>(i / 64) / 64}));
    const auto one = map_of(scene, params, 1);
    const auto expected = support::irradiance(*one, points);
    for (const int threads : {2, 3}) {
        const auto more = map_of(scene, params, threads);
        EXPECT_EQ(one->build_report().counters, more->build_report().counters);
        const auto found = support::irradiance(*more, points);
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_TRUE((found[i].value == expected[i].value).all());
    }
    EXPECT_GT(std::ranges::count_if(expected, [](const Estimate& e) { return e.value[0] > 0; }),
              500);
}

TEST(IlluminationMap, KeepsTheSidesOfAThinReceiverApart) {
    const Scene scene(daylight_scene(support::diffuse(0.5F, true)));
    const auto map = map_of(scene, {.emitted = 50'000, .resolution = 4});
    const Vec2 middle(0.5F, 0.5F);
    EXPECT_GT(support::irradiance(*map, {on_shape(scene, 1, middle)})[0].value[0], 1);
    EXPECT_EQ(support::irradiance(*map, {on_shape(scene, 1, middle, false)})[0].value[0], 0);
}

std::string refusal(const SceneDesc& desc, const IlluminationMapParams& params) {
    const Scene scene(desc);
    try {
        map_of(scene, params);
    } catch (const UnsupportedScene& error) {
        return error.what();
    }
    return "taken";
}

// Asked only whether it can, it makes no texels of exact shapes, but refuses the same.
TEST(IlluminationMap, RefusesWhatItCannotHold) {
    SceneDesc crate = daylight_scene(support::diffuse(0.5F));
    crate.shapes[1] =
        support::mesh("plate", tessellate_cube(2), Transform::Identity(), support::diffuse(0.5F));
    for (const bool only_checked : {false, true}) {
        const IlluminationMapParams params{.emitted = 10, .only_checked = only_checked};
        const std::string glossy = refusal(daylight_scene(support::schlick(0.5F, 0.1F)), params);
        EXPECT_NE(glossy.find("\"plate\" is not"), std::string::npos) << glossy;
        EXPECT_NE(refusal(crate, params).find("\"plate\" has texture coordinates that overlap"),
                  std::string::npos);
        EXPECT_EQ(refusal(daylight_scene(support::diffuse(0.5F)), params), "taken");
    }
}

}  // namespace
}  // namespace caustics

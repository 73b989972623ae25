#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"
#include "tests/support/flat_pool.h"
#include "tests/support/picture_agreement.h"

namespace caustics {
namespace {

// The references' pictures against closed forms, pixel by pixel, sure enough in the mean to tell 1 %.

constexpr double albedo = 0.5;
using support::flat_pool::depth;
using support::flat_pool::index;
constexpr double eye_height = 0.9;
constexpr double half_view = 0.9;
constexpr int side = 20;
constexpr double sigma = 0.0016;

// Water z = 0 over a floor, which a camera under the water sees from straight above.
SceneDesc pool(double half_water) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -depth, 6, true, support::diffuse(albedo)),
                   support::horizontal("water", 0, half_water, true,
                                       support::glass(static_cast<float>(index)))};
    desc.camera = support::camera({0, 0, eye_height - depth}, {0, 0, -depth}, {0, 1, 0},
                                  360 / pi_d * std::atan(half_view / eye_height), side, side);
    return desc;
}

// The radiance of a floor of which the irradiance is known by the distance from the axis; each pixel
// the mean over 8 x 8 of its points.
Film picture_of(const std::function<double(double)>& irradiance) {
    constexpr int n = 8;
    Film film(side, side);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        double sum = 0;
        for (int k = 0; k < n * n; ++k) {
            const double x = static_cast<double>(i % side) + (k % n + 0.5) / n;
            const double y = static_cast<double>(i / side) + (k / n + 0.5) / n;
            sum += irradiance(half_view * std::hypot(2 * x / side - 1, 2 * y / side - 1));
        }
        film.set_rgb("caustic", i,
                     Spectrum::Constant(static_cast<float>(albedo / pi_d * sum / (n * n))));
    }
    return film;
}

template <typename Params>
Film picture(SceneDesc desc, const Params& params, int eye_samples) {
    const Scene scene(std::move(desc));
    RunOptions options;
    options.samples_per_pixel = eye_samples;
    return render(scene, *build(scene, params, options), options).film;
}

// The picture is the truth, and neither 1 % more nor 1 % less.
void expect_is(const Film& found, const std::function<double(double)>& irradiance) {
    EXPECT_EQ(support::disagreement(found, picture_of(irradiance), sigma), "");
    for (const double factor : {0.99, 1.01})
        EXPECT_NE(support::PictureScores(
                      found, picture_of([&](double r) { return factor * irradiance(r); }))
                      .complaint(sigma),
                  "")
            << factor;
}

TEST(ReferenceTruths, LightTraceUnderAPool) {
    SceneDesc desc = pool(0.8);
    desc.lights = {support::point_light({0, 0, support::flat_pool::height},
                                        static_cast<float>(support::flat_pool::intensity))};
    expect_is(picture(std::move(desc), LightTraceParams{.paths = 1'200'000}, 1),
              [](double r) { return support::flat_pool::floor_irradiance(r); });
}

// A sky of radiance 1 all round: the floor sees it through the cone of total reflection, whose foot the
// water covers, and gets what the water lets through, pi less the integral of R cos over the sky.
TEST(ReferenceTruths, PathTraceUnderAPoolAndAWhiteSky) {
    SceneDesc desc = pool(2.7);
    desc.shapes.push_back(support::enclosure(9, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Ones());
    double transmitted = 0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double cosine = std::sqrt((i + 0.5) / steps);
        transmitted += pi_d * (1 - support::fresnel(cosine, index)) / steps;
    }
    expect_is(picture(std::move(desc), PathTraceParams{.spp = 1024}, 1024),
              [&](double) { return transmitted; });
}

}  // namespace
}  // namespace caustics

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/build_scene.h"
#include "tests/support/light_flux.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// Two glass balls one behind the other and a mirror beside them, whose bounds overlap as seen from
// every light, over a floor.
SceneDesc crowded() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 4, true, support::diffuse(0.5F)),
                   support::sphere("near", {0.2, 0.1, 2}, 0.5, support::glass(1.5F)),
                   support::sphere("far", {0.4, -0.2, 1}, 0.6, support::glass(1.33F)),
                   support::rectangle("mirror", {-0.9, 0.2, 1.4}, {0, 0.8, 0}, {0, 0, 0.8},
                                      support::mirror(0.8F)),
                   // Faces down and aside.
                   support::rectangle("light", {0.6, 0.4, 3.4}, {0, 0.4, 0}, {0.4, 0, 0.1},
                                      support::diffuse(0))};
    return desc;
}

void shine(Shape& shape, float radiance) {
    shape.radiance = Spectrum(Spectrum::Constant(radiance));
}

// The floor in 6 x 6 cells.
int floor_cell(const Deposit& d) {
    if (d.shape != 0) return -1;
    const int x = std::clamp(static_cast<int>((d.position.x() + 3) * 1.0F), 0, 5);
    const int y = std::clamp(static_cast<int>((d.position.y() + 3) * 1.0F), 0, 5);
    return 6 * y + x;
}

void expect_same(const support::ArrivedFlux& a, const support::ArrivedFlux& b) {
    double variance = 0;
    for (std::size_t i = 0; i < a.mean.size(); ++i) {
        const double error = std::hypot(a.standard_error[i], b.standard_error[i]);
        variance += error * error;
        if (error == 0) {
            EXPECT_EQ(a.mean[i], b.mean[i]);
            continue;
        }
        EXPECT_LT(std::abs(a.mean[i] - b.mean[i]) / error, support::sidak_bound(36))
            << "cell " << i << ": " << a.mean[i] << " and " << b.mean[i];
    }
    EXPECT_NEAR(a.total(), b.total(), 4 * std::sqrt(variance));
    EXPECT_LT(std::sqrt(variance), 0.01 * b.total());
}

// Aimed and thinned emission brings what emission without any aim brings, each cell by Sidak's
// bound and in all within 4 sigma, below 4 %.
void expect_aim_changes_nothing(const Scene& scene) {
    const AimedEmission emission(scene);
    const auto a =
        support::arrived_flux(scene, support::aimed(emission), 400'000, 36, floor_cell, 1);
    const auto b = support::arrived_flux(scene, support::unaimed(scene, scene.lights()[0]),
                                         2'000'000, 36, floor_cell, 2);
    expect_same(a, b);
}

TEST(AimedEmission, OfAPointLight) {
    SceneDesc desc = crowded();
    desc.lights = {support::point_light({0.1, 0.2, 3.5}, 5)};
    expect_aim_changes_nothing(Scene(std::move(desc)));
}

TEST(AimedEmission, OfADirectionalLight) {
    SceneDesc desc = crowded();
    desc.lights = {support::directional_light({-0.3, 0.1, -1}, 2)};
    expect_aim_changes_nothing(Scene(std::move(desc)));
}

TEST(AimedEmission, OfASquareLight) {
    SceneDesc desc = crowded();
    shine(desc.shapes.back(), 6);
    expect_aim_changes_nothing(Scene(std::move(desc)));
}

TEST(AimedEmission, OfASphereLight) {
    SceneDesc desc = crowded();
    desc.shapes.back() = support::sphere("light", {0.6, 0.4, 3.4}, 0.3, support::diffuse(0));
    shine(desc.shapes.back(), 6);
    expect_aim_changes_nothing(Scene(std::move(desc)));
}

TEST(AimedEmission, LightsAddUpAndPhotonsAreEqual) {
    SceneDesc desc = crowded();
    desc.lights = {support::point_light({0.1, 0.2, 3.5}, 5),
                   support::directional_light({-0.3, 0.1, -1}, 2)};
    shine(desc.shapes.back(), 6);
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    for (std::uint64_t i = 0; i < 10'000; ++i) {
        Rng rng(3, Stage::test, i);
        const auto particle = emission.emit(rng);
        if (!particle) continue;
        ASSERT_NEAR(particle->flux.mean() / emission.total_power().mean(), 1, 1e-5F);
    }
    const auto all =
        support::arrived_flux(scene, support::aimed(emission), 800'000, 36, floor_cell, 4);
    support::ArrivedFlux sum;
    sum.mean.assign(36, 0);
    sum.standard_error.assign(36, 0);
    for (std::size_t light = 0; light < 3; ++light) {
        const auto one =
            support::arrived_flux(scene, support::unaimed(scene, scene.lights()[light]), 1'500'000,
                                  36, floor_cell, 5 + light);
        for (std::size_t i = 0; i < 36; ++i) {
            sum.mean[i] += one.mean[i];
            sum.standard_error[i] = std::hypot(sum.standard_error[i], one.standard_error[i]);
        }
    }
    expect_same(all, sum);
}

// Solid angle of a rectangle of half sizes a, b seen from distance d above its middle.
double solid_angle(double a, double b, double d) {
    return 4 * std::asin(a * b / std::sqrt((a * a + d * d) * (b * b + d * d)));
}

// One mirror before another: the front one sends back I times its solid angle, the hinder one what
// it shows round it, all onto an enclosure.
TEST(AimedEmission, MirrorsThatHideEachOtherShareTheirSolidAngle) {
    SceneDesc desc;
    desc.shapes = {
        support::enclosure(10, support::diffuse(0.5F)),
        support::rectangle("front", {0, 0, -1}, {0.4, 0, 0}, {0, 0.3, 0}, support::mirror()),
        support::rectangle("back", {0, 0, -1.5}, {1.2, 0, 0}, {0, 0.9, 0}, support::mirror())};
    desc.lights = {support::point_light(Vec3d::Zero(), 1)};
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    const auto flux = support::flux_by_shape(scene, support::aimed(emission), 500'000, 6, 1000);
    // Light reflected by the hinder mirror onto the front's back returns to it and so on: lossless.
    const double expected = solid_angle(1.2, 0.9, 1.5);
    EXPECT_GT(expected, solid_angle(0.4, 0.3, 1));
    EXPECT_NEAR(flux.mean[0], expected, 4 * flux.standard_error[0]);
    EXPECT_LT(flux.standard_error[0], 0.003 * expected);
}

// A small mirror ball far from its light catches I 2 pi (1 - cos), sin = r / d, and loses nothing.
// The cone is little wider than the ball, so nearly every aimed photon hits: what the cone's
// rounding cut off would be missing in the flux.
TEST(AimedEmission, AtSmallBallsFarAway) {
    constexpr double d = 10;
    for (const double sine : {0.3, 0.1, 0.03, 0.01, 4e-3, 2e-3, 1e-3, 5e-4, 1e-4}) {
        SceneDesc desc;
        desc.shapes = {support::enclosure(2 * d, support::diffuse(0.5F)),
                       support::sphere("ball", Vec3d::Zero(), sine * d, support::mirror())};
        desc.lights = {support::point_light({d * 0.48, d * 0.6, d * 0.64}, 1)};
        const Scene scene(std::move(desc));
        const AimedEmission emission(scene);
        const auto flux = support::flux_by_shape(scene, support::aimed(emission), 20'000, 7);
        const double expected = 2 * pi_d * sine * sine / (1 + std::sqrt(1 - sine * sine));
        EXPECT_NEAR(flux.mean[0] / expected, 1, 5e-4 + 4 * flux.standard_error[0] / expected)
            << "r / d = " << sine;
    }
}

}  // namespace
}  // namespace caustics

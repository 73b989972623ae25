#include "beamtree/tracing/beam_tracing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/beamtree/beam_scenes.h"
#include "tests/support/fresnel.h"

namespace caustics::beamtree {
namespace {

double flux(const BeamScene& scene, bool refracted) {
    double sum = 0;
    for (const BeamSet& set : scene.sets)
        if (set.refracted == refracted)
            for (const Beam& beam : set.beams) sum += static_cast<double>(beam.flux.mean());
    return sum;
}

// The solid angle of the square |x|, |y| <= a seen from height h over its middle.
double square_solid_angle(double a, double h) { return 4 * std::asin(a * a / (a * a + h * h)); }

TEST(BeamTracing, SendsOnTheFluxThatArrives) {
    for (const int resolution : {1, 3, 16}) {
        SceneDesc desc;
        desc.shapes = {support::mesh("mirror", tessellate_rectangle(resolution),
                                     Transform::Identity(), support::mirror(0.8F))};
        desc.lights = {support::point_light({0, 0, 0.7}, 3)};
        const BeamScene scene("mirror", desc);
        EXPECT_NEAR(flux(scene, false) / (0.8 * 3 * square_solid_angle(1, 0.7)), 1, 1e-6);
        EXPECT_EQ(flux(scene, true), 0);
    }
}

// What water lets through at 32 x 32 against 512 x 512: 1e-4, and nothing is lost between the two.
TEST(BeamTracing, FluxThroughWaterNeedsNoFineMesh) {
    const BeamScene fine("pool", pool_desc(512));
    const BeamScene coarse("pool", pool_desc(32));
    EXPECT_NEAR(flux(coarse, true) / flux(fine, true), 1, 1e-4);
    const double both = flux(coarse, true) + flux(coarse, false);
    EXPECT_NEAR(both / (flux(fine, true) + flux(fine, false)), 1, 1e-4);
}

TEST(BeamTracing, WeighsADirectionalLightByItsArea) {
    SceneDesc desc;
    desc.shapes = {
        support::mesh("mirror", tessellate_rectangle(4), Transform::Identity(), support::mirror())};
    desc.lights = {support::directional_light({0.6, 0, -0.8}, 2)};
    const BeamScene scene("mirror", desc);
    EXPECT_NEAR(flux(scene, false), 2 * 4 * 0.8, 1e-6);
}

// One sample of an area light shines like radiance x area x cosine.
TEST(BeamTracing, SharesAnAreaLightAmongItsSamples) {
    SceneDesc desc;
    desc.shapes = {
        support::mesh("mirror", tessellate_rectangle(32), Transform::Identity(), support::mirror()),
        support::horizontal("light", 40, 0.01, false, support::diffuse(0))};
    desc.shapes[1].radiance = Spectrum(Spectrum::Constant(5000));
    for (const int samples : {1, 7}) {
        const BeamScene scene("mirror", desc, PolygonKind::triangle, samples);
        EXPECT_EQ(scene.sets.size(), static_cast<std::size_t>(samples));
        // E = L A / d^2 over 4 m^2.
        EXPECT_NEAR(flux(scene, false) / (5000 * 4e-4 * 4 / 1600), 1, 2e-3);
    }
}

// Light from inside water, 1 m below a still surface of 1.333: beyond asin(1 / 1.333) nothing is
// refracted. The triangles at that circle are cut, so that its flux comes out better than to the
// mesh's step; where the circle lies between the corners of coarse triangles, those are quartered.
TEST(BeamTracing, CutsAtTotalReflection) {
    const double limit = std::asin(1 / 1.333);
    double truth = 0;
    constexpr int steps = 20'000;
    for (int i = 0; i < steps; ++i) {
        const double angle = limit * (i + 0.5) / steps;
        truth += 2 * pi_d * std::sin(angle) * (1 - support::fresnel(std::cos(angle), 1 / 1.333)) *
                 limit / steps;
    }
    for (const int resolution : {1, 2, 3, 4, 8, 32}) {
        SceneDesc desc;
        const Transform size(Eigen::Scaling(3.0, 3.0, 1.0));
        desc.shapes = {
            support::mesh("water", tessellate_rectangle(resolution), size, support::glass(1.333F))};
        desc.lights = {support::point_light({0.02, 0.03, -1}, 1)};
        const BeamScene scene("water", desc);
        const bool fine = resolution == 32;
        EXPECT_NEAR(flux(scene, true) / truth, 1, fine ? 5e-3 : 0.025) << resolution;
        // Everything is reflected or refracted, up to the cut triangles' curved rim.
        EXPECT_NEAR((flux(scene, true) + flux(scene, false)) / square_solid_angle(3, 1), 1,
                    fine ? 3e-3 : 0.015)
            << resolution;
    }
}

// Rays of cut polygons are rays like others; a cut leaves four corners.
TEST(BeamTracing, GivesCutPolygonsUnitRays) {
    SceneDesc desc;
    const Transform size(Eigen::Scaling(3.0, 3.0, 1.0));
    desc.shapes = {support::mesh("water", tessellate_rectangle(32), size, support::glass(1.333F))};
    desc.lights = {support::point_light({0.02, 0.03, -1}, 1)};
    const BeamScene scene("water", desc);
    bool cut = false;
    for (const BeamSet& set : scene.sets)
        for (const Beam& beam : set.beams) {
            cut = cut || beam.triangle_count() == 2;
            for (const std::uint32_t corner : beam.corners)
                if (corner != Beam::none) {
                    EXPECT_NEAR(set.rays[corner].direction.norm(), 1, 1e-5);
                }
        }
    EXPECT_TRUE(cut);
}

// A whole ball: the lit side only, cut at the terminator.
TEST(BeamTracing, LeavesOutPolygonsTurnedAway) {
    SceneDesc desc = ball_desc(24);
    desc.shapes[0].bsdf.twosided = false;
    const BeamScene ball("ball", desc);
    const Vec3 light(1.5F, 0.4F, 1.6F);
    const Vec3 centre(0, 0, 0.6F);
    const double distance = static_cast<double>((light - centre).norm());
    const double cap = 2 * pi_d * (1 - std::sqrt(1 - 0.25 / (distance * distance)));
    EXPECT_NEAR(flux(ball, false) / (5 * cap), 1, 0.02);
    for (const Beam& beam : ball.sets[0].beams) {
        const auto rays = ball.sets[0].triangle(beam, 0);
        for (const VertexRay* ray : rays)
            EXPECT_GE((ray->position - centre).normalized().dot(ray->direction), -1e-3F);
    }
}

}  // namespace
}  // namespace caustics::beamtree

#include "beamtree/beam_tracing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/error.h"
#include "tests/beamtree/beam_scenes.h"
#include "tests/support/fresnel.h"

namespace caustics {
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
        desc.point_lights = {support::point_light({0, 0, 0.7}, 3)};
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
    desc.directional_lights = {support::directional_light({0.6, 0, -0.8}, 2)};
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
        const BeamScene scene("mirror", desc, samples);
        EXPECT_EQ(scene.sets.size(), static_cast<std::size_t>(samples));
        // E = L A / d^2 over 4 m^2.
        EXPECT_NEAR(flux(scene, false) / (5000 * 4e-4 * 4 / 1600), 1, 2e-3);
    }
}

// Light from inside water, 1 m below a still surface of 1.333: beyond asin(1 / 1.333) nothing is
// refracted. The triangles at that circle are cut, so that its flux comes out better than to the
// mesh's step.
TEST(BeamTracing, CutsAtTotalReflection) {
    SceneDesc desc;
    const Transform size(Eigen::Scaling(3.0, 3.0, 1.0));
    desc.shapes = {support::mesh("water", tessellate_rectangle(32), size, support::glass(1.333F))};
    desc.point_lights = {support::point_light({0.02, 0.03, -1}, 1)};
    const BeamScene scene("water", desc);
    const double limit = std::asin(1 / 1.333);
    double truth = 0;
    constexpr int steps = 20'000;
    for (int i = 0; i < steps; ++i) {
        const double angle = limit * (i + 0.5) / steps;
        truth += 2 * pi_d * std::sin(angle) * (1 - support::fresnel(std::cos(angle), 1 / 1.333)) *
                 limit / steps;
    }
    EXPECT_NEAR(flux(scene, true) / truth, 1, 5e-3);
    // Everything is reflected or refracted, up to the cut triangles' curved rim.
    EXPECT_NEAR((flux(scene, true) + flux(scene, false)) / square_solid_angle(3, 1), 1, 3e-3);
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

/// What build() makes of a scene at points all over its floor.
std::vector<Estimate> on_floor(const Scene& scene, std::size_t floor,
                               const BeamTreeParams& params = {}) {
    const auto method = build(scene, params, RunOptions{});
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 400; ++i)
        points.push_back(support::probe(
            scene, floor, {-0.95 + 0.1 * (i % 20), -0.95 + 0.1 * (i / 20), 0}, Vec3d::UnitZ(), 0));
    for (ReceiverPoint& point : points)
        point.position.z() = bounds(scene.shapes()[floor]).max().z();
    return support::irradiance(*method, points);
}

double mean(const std::vector<Estimate>& estimates) {
    double sum = 0;
    for (const Estimate& e : estimates) {
        EXPECT_TRUE(is_finite(e.value));
        sum += static_cast<double>(e.value.mean());
    }
    return sum / static_cast<double>(estimates.size());
}

TEST(BeamTree, BadTrianglesChangeNothing) {
    const double good = mean(on_floor(Scene(pool_desc(16)), 1));
    ASSERT_GT(good, 0);
    SceneDesc desc = pool_desc(16);
    TriangleMesh& water = desc.shapes[0].mesh;
    water.patches.clear();
    const std::size_t count = water.triangles.size();
    for (std::size_t i = 0; i < count; i += 7) {
        auto [a, b, c] = water.triangles[i];
        water.triangles.push_back({b, c, a});  // there already
        water.triangles.push_back({b, a, c});  // there already, turned round
        water.triangles.push_back({a, a, b});  // no area
    }
    const Scene scene(desc);
    EXPECT_NEAR(mean(on_floor(scene, 1)) / good, 1, 1e-6);
    const BuildReport report = build(scene, BeamTreeParams{}, RunOptions{})->build_report();
    EXPECT_EQ(report.counters.at("polygons_degenerate"), (count + 6) / 7);
    EXPECT_EQ(report.counters.at("polygons_duplicated"), 2 * ((count + 6) / 7));
    EXPECT_EQ(report.resolved.at("trees_binned"), 2);
    EXPECT_EQ(report.resolved.at("trees_quadtree"), 0);
}

TEST(BeamTree, HolesLetNothingThroughTheWater) {
    const double whole = mean(on_floor(Scene(pool_desc(16)), 1));
    SceneDesc desc = pool_desc(16);
    std::erase_if(desc.shapes[0].mesh.triangles, [](const auto& t) { return t[0] % 5 == 0; });
    desc.shapes[0].mesh.patches.clear();
    const double holed = mean(on_floor(Scene(desc), 1));
    EXPECT_LT(holed, 0.9 * whole);
    EXPECT_GT(holed, 0.5 * whole);
}

// Without normals every triangle bends light by its own plane, as all methods see such a mesh.
TEST(BeamTree, AMeshWithoutNormalsIsFlat) {
    SceneDesc desc = pool_desc(16);
    desc.shapes[0].mesh.normals.clear();
    const Scene scene(desc);
    const BuildReport report = build(scene, BeamTreeParams{}, RunOptions{})->build_report();
    EXPECT_EQ(report.resolved.at("casters_with_face_normals"), 1);
    EXPECT_NEAR(mean(on_floor(scene, 1)) / mean(on_floor(Scene(pool_desc(16)), 1)), 1, 0.15);
}

// Normals against the winding: core's rule for every method is that such light is lost.
TEST(BeamTree, InvertedWindingIsDarkAndInvertedBothIsTheInside) {
    SceneDesc desc = pool_desc(16);
    for (auto& triangle : desc.shapes[0].mesh.triangles) std::swap(triangle[1], triangle[2]);
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
    for (Vec3& normal : desc.shapes[0].mesh.normals) normal = -normal;
    EXPECT_GT(mean(on_floor(Scene(desc), 1)), 0);
}

TEST(BeamTree, TotalReflectionEverywhereIsDarkBelow) {
    SceneDesc desc = pool_desc(8);
    desc.shapes[0].bsdf = support::glass(1.0F, 3.0F);
    desc.point_lights = {support::point_light({3, 0, 0.2}, 10)};
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
}

TEST(BeamTree, NothingLitIsBlack) {
    SceneDesc desc = pool_desc(8);
    desc.point_lights.clear();
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
    desc = pool_desc(8);
    desc.shapes.erase(desc.shapes.begin());
    EXPECT_EQ(mean(on_floor(Scene(desc), 0)), 0);
}

// A glass ball sends nearly all of its light through a second surface.
TEST(BeamTree, SaysWhereOneEventIsNotEnough) {
    SceneDesc desc = ball_desc(16);
    desc.shapes[0].bsdf = support::glass(1.5F);
    const Scene glass(desc);
    EXPECT_THROW(build(glass, BeamTreeParams{}, RunOptions{}), UnsupportedScene);
    BeamTreeParams one;
    one.max_bounces = 1;
    EXPECT_GT(mean(on_floor(glass, 1, one)), 0);
    const BuildReport report = build(glass, one, RunOptions{})->build_report();
    EXPECT_GT(report.resolved.at("flux_share_to_second_event"), 0.8);
    // The same ball under water: its polygons are in the shadow of the water.
    SceneDesc inside = pool_desc(16);
    inside.shapes.push_back(support::mesh(
        "ball", tessellate_sphere(8),
        Transform(Eigen::Translation3d(0, 0, -0.5) * Eigen::Scaling(0.1)), support::glass(1.5F)));
    EXPECT_LT(mean(on_floor(Scene(inside), 1)), mean(on_floor(Scene(pool_desc(16)), 1)));
}

TEST(BeamTree, EveryBoundAndHierarchyGivesTheSameBits) {
    const Scene scene(pool_desc(12));
    const std::vector<Estimate> first = on_floor(scene, 1);
    for (const Bound bound : {Bound::single, Bound::double_cone, Bound::sphere_swept})
        for (const auto tree : {BeamTreeParams::Tree::quadtree, BeamTreeParams::Tree::binned}) {
            BeamTreeParams params;
            params.bound = bound;
            params.hierarchy = tree;
            const std::vector<Estimate> other = on_floor(scene, 1, params);
            for (std::size_t i = 0; i < first.size(); ++i)
                EXPECT_TRUE((first[i].value == other[i].value).all());
        }
}

}  // namespace
}  // namespace caustics

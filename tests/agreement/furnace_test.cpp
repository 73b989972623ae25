#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/geometry/tessellate.h"
#include "core/reference/path_trace.h"
#include "core/render/direct_light.h"
#include "tests/support/build_scene.h"
#include "tests/support/light_flux.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// A closed room whose walls all emit L round lossless bodies: radiance is L everywhere along every
// ray, so that a wall point is lit by pi L, straight or through the bodies. And what goes through
// them is what falls on them: pi L times the surface of a convex body.
constexpr double half_room = 2;
constexpr float wall_radiance = 1;
constexpr float reflectance = 0.5F;
/// Enough that none is cut off, by total reflection inside a cube say.
constexpr int max_bounces = 200;

Scene room_with(std::vector<Shape> bodies) {
    SceneDesc desc;
    desc.shapes = support::emitting_room(half_room, wall_radiance, support::diffuse(reflectance));
    for (Shape& body : bodies) desc.shapes.push_back(std::move(body));
    return Scene(std::move(desc));
}

// Two points on each wall, one near the middle, one towards a corner.
std::vector<ReceiverPoint> wall_points(const Scene& scene) {
    std::vector<ReceiverPoint> points;
    for (std::size_t wall = 0; wall < 6; ++wall) {
        const Transform& to_world = scene.shapes()[wall].to_world;
        for (const Vec3d& local : {Vec3d(0.1, -0.2, 0), Vec3d(0.7, 0.55, 0)})
            points.push_back(support::probe(scene, wall, to_world * local, to_world.linear().col(2),
                                            points.size()));
    }
    return points;
}

support::Moments direct_irradiance(const Scene& scene, const ReceiverPoint& point, int samples) {
    support::Moments direct;
    for (int i = 0; i < samples; ++i) {
        Rng rng(point.id + 1, Stage::test, static_cast<std::uint64_t>(i));
        direct.add(static_cast<double>(direct_radiance(scene, point, rng)[0] * pi / reflectance));
    }
    return direct;
}

// (direct + caustic) / (pi L) at the wall points: each within its error by Sidak's bound, their
// mean within 4 standard errors, which are below 0.15 %.
void expect_furnace(const Scene& scene) {
    constexpr int samples = 20'000;
    const std::vector<ReceiverPoint> points = wall_points(scene);
    const auto reference =
        build(scene, PathTraceParams{.spp = samples, .max_bounces = max_bounces}, RunOptions{});
    const std::vector<Estimate> caustic = support::irradiance(*reference, points);
    double sum = 0;
    double variance = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const support::Moments direct = direct_irradiance(scene, points[i], samples);
        const double found = direct.mean() + static_cast<double>(caustic[i].value[0]);
        const double error =
            std::hypot(direct.standard_error(), static_cast<double>(caustic[i].standard_error[0]));
        EXPECT_GT(caustic[i].value[0], 0);
        EXPECT_LT(std::abs(found - pi_d) / error, support::sidak_bound(points.size()))
            << "at " << points[i].position.transpose() << ": " << found / pi_d << " of pi L";
        sum += found;
        variance += error * error;
    }
    const auto n = static_cast<double>(points.size());
    EXPECT_LT(std::sqrt(variance) / n, 0.0015 * pi_d);
    EXPECT_NEAR(sum / n / pi_d, 1, 4 * std::sqrt(variance) / n / pi_d);
}

// Light tracing: the flux that arrives through a convex body, 4 standard errors of about 0.4 %.
void expect_flux_of_surface(const Scene& scene, double surface) {
    const AimedEmission emission(scene);
    const auto flux =
        support::flux_by_shape(scene, support::aimed(emission), 800'000, 1, max_bounces);
    double variance = 0;
    for (const double error : flux.standard_error) variance += error * error;
    const double expected = pi_d * static_cast<double>(wall_radiance) * surface;
    EXPECT_NEAR(flux.total() / expected, 1, 4 * std::sqrt(variance) / expected);
    // Roulette ends a few of the paths that have more than 64 events.
    EXPECT_LT(flux.counts.absorbed, flux.counts.stored / 1000);
    EXPECT_EQ(flux.counts.escaped, 0U);
}

Transform tilted(double scale) {
    return Eigen::Translation3d(0.2, -0.1, 0.3) *
           Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()) * Eigen::Scaling(scale);
}

Shape glass_ball() { return support::sphere("ball", {0.3, -0.2, 0.1}, 1, support::glass(1.5F)); }

TEST(Furnace, AroundAnExactBall) {
    const Scene scene = room_with({glass_ball()});
    expect_furnace(scene);
    expect_flux_of_surface(scene, 4 * pi_d);
}

TEST(Furnace, AroundAFlatShadedMeshBall) {
    const TriangleMesh ball = support::flat(tessellate_sphere(8));
    const Scene scene = room_with({support::mesh("ball", ball, tilted(1.0), support::glass(1.5F))});
    expect_furnace(scene);
    expect_flux_of_surface(scene, support::mesh_area(scene.shapes()[6].mesh));
}

TEST(Furnace, AroundATiltedCube) {
    const Scene scene =
        room_with({support::mesh("cube", tessellate_cube(1), tilted(0.7), support::glass(1.3F))});
    expect_furnace(scene);
    expect_flux_of_surface(scene, support::mesh_area(scene.shapes()[6].mesh));
}

TEST(Furnace, AroundAMirrorBall) {
    const Scene scene =
        room_with({support::sphere("ball", {0.3, -0.2, 0.1}, 1, support::mirror())});
    expect_furnace(scene);
    expect_flux_of_surface(scene, 4 * pi_d);
}

TEST(Furnace, AroundAnAirBubbleInGlassAndASecondBall) {
    const Scene scene =
        room_with({support::sphere("ball", {-0.6, 0, 0}, 1, support::glass(1.5F)),
                   support::sphere("bubble", {-0.5, 0.1, 0}, 0.6, support::glass(1, 1.5F)),
                   support::mesh("other", support::flat(tessellate_sphere(6)),
                                 Eigen::Translation3d(1.1, 0.3, 0.5) * Eigen::Scaling(0.6),
                                 support::glass(1.33F))});
    expect_furnace(scene);
}

// Water fills the room's lower half; in equilibrium its radiance is n^2 L, so the walls below emit
// that much, and wall points there are lit by pi n^2 L.
TEST(Furnace, RadianceInWaterIsNSquaredTimesThatInAir) {
    constexpr double n = 1.333;
    SceneDesc desc;
    const Bsdf bsdf = support::diffuse(reflectance);
    const double eps = 1e-4;
    for (const bool wet : {false, true}) {
        const double z = wet ? -0.5 : 0.5;
        const float radiance = wet ? static_cast<float>(n * n) : 1.0F;
        std::vector<Shape> walls;
        for (int side = 0; side < 4; ++side) {
            const double angle = side * pi_d / 2;
            const Vec3d outward(std::cos(angle), std::sin(angle), 0);
            const Vec3d across(-std::sin(angle), std::cos(angle), 0);
            // u x v = up x across = -outward.
            walls.push_back(
                support::rectangle("wall", outward + Vec3d(0, 0, z), {0, 0, 0.5}, across, bsdf));
        }
        walls.push_back(support::horizontal("cap", 2 * z, 1, wet, bsdf));
        for (Shape& wall : walls) {
            wall.radiance = Spectrum(Spectrum::Constant(radiance));
            desc.shapes.push_back(wall);
        }
    }
    desc.shapes.push_back(
        support::horizontal("water", 0, 1 + eps, true, support::glass(static_cast<float>(n))));
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    std::vector<double> expected;
    for (std::size_t wall = 0; wall < 10; ++wall) {
        const Transform& to_world = scene.shapes()[wall].to_world;
        points.push_back(support::probe(scene, wall, to_world * Vec3d(0.3, -0.4, 0),
                                        to_world.linear().col(2), wall));
        expected.push_back(wall < 5 ? pi_d : pi_d * n * n);
    }
    constexpr int samples = 30'000;
    const auto reference =
        build(scene, PathTraceParams{.spp = samples, .max_bounces = max_bounces}, RunOptions{});
    const std::vector<Estimate> caustic = support::irradiance(*reference, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const support::Moments direct = direct_irradiance(scene, points[i], samples);
        const double found = direct.mean() + static_cast<double>(caustic[i].value[0]);
        const double error =
            std::hypot(direct.standard_error(), static_cast<double>(caustic[i].standard_error[0]));
        EXPECT_LT(std::abs(found - expected[i]) / error, support::sidak_bound(points.size()))
            << "wall " << i << ": " << found / expected[i];
        EXPECT_LT(error, 0.01 * expected[i]);
    }
    // And as flux: what crosses the water both ways, reflections included, falls on the walls:
    // pi (1 + n^2) L times the water's 4 m^2.
    const AimedEmission emission(scene);
    const auto flux =
        support::flux_by_shape(scene, support::aimed(emission), 800'000, 2, max_bounces);
    double variance = 0;
    for (const double error : flux.standard_error) variance += error * error;
    const double total = pi_d * (1 + n * n) * 4;
    EXPECT_NEAR(flux.total() / total, 1, 4 * std::sqrt(variance) / total);
}

}  // namespace
}  // namespace caustics

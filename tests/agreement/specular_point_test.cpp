#include "beamtree/light/root_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/agreement/exact_pool.h"
#include "tests/support/flat_pool.h"

namespace caustics {
namespace {

using namespace exact_pool;

// `intensity: refined` on casters that are exact shapes: what a point gets is right to the rounding of its
// place in float, whatever the polygons, wherever these find the right rays.

Shape exact_water() {
    Shape shape = meshed({});
    shape.primitive = Primitive::heightfield;
    shape.field = water();
    return shape;
}

beamtree::BeamTreeParams of(beamtree::Intensity intensity, int resolution) {
    beamtree::BeamTreeParams params = with(intensity);
    params.mesh_resolution = resolution;
    return params;
}

TEST(SpecularPoints, TellWavyWaterToRounding) {
    for (const Lamp lamp : {Lamp::point, Lamp::directional, Lamp::area}) {
        const PointwiseTruth truth(lamp);
        const Errors coarse = truth.errors(exact_water(), of(beamtree::Intensity::refined, 48));
        const Errors fine = truth.errors(exact_water(), of(beamtree::Intensity::refined, 96));
        EXPECT_LT(coarse.median, 1e-6);
        EXPECT_LT(fine.median, 1e-6);
        // All rays are found beside folds, too. An error above 1 counts as 1: one point of a thousand, on a fold, may have one.
        EXPECT_LT(coarse.mean, 0.0011);
        EXPECT_LT(fine.mean, 0.0011);
        // The control: eq. 11 on the same polygons.
        EXPECT_GT(truth.errors(exact_water(), of(beamtree::Intensity::area, 96)).median, 0.01);
    }
}

/// A point light on the axis of a shape of revolution: light that leaves it at the angle a to -z, within
/// da of it, is spread over the ring 2 pi r |dr/da| of the floor.
double on_ring(double intensity, double angle, double radius, double slope) {
    return intensity * std::sin(angle) / (radius * std::abs(slope));
}

constexpr double strength = 5;

// A mirror ball below the light sends it back up to a ceiling.
TEST(SpecularPoints, TellAMirrorBall) {
    constexpr double light_z = 4, ball_z = 1, radius = 0.5, ceiling = 4.5;
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, ball_z}, radius, support::mirror()),
                   support::horizontal("ceiling", ceiling, 9, false, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, light_z}, strength)};
    const Scene scene(std::move(desc));
    const auto landing = [&](double a) {
        const double distance = light_z - ball_z;
        const double c = distance * std::cos(a);
        const double t = c - std::sqrt(c * c - distance * distance + radius * radius);
        const Vec2d hit(t * std::sin(a), light_z - t * std::cos(a));
        const Vec2d n = (hit - Vec2d(0, ball_z)) / radius;
        const Vec2d d(std::sin(a), -std::cos(a));
        const Vec2d out = d - 2 * d.dot(n) * n;
        return hit.x() + (ceiling - hit.y()) / out.y() * out.x();
    };
    const auto method = build(scene, of(beamtree::Intensity::refined, 24), {});
    for (const double angle : {0.02, 0.05, 0.08, 0.1}) {
        const double r = landing(angle);
        const double slope = (landing(angle + 1e-6) - landing(angle - 1e-6)) / 2e-6;
        const Vec3d point(r * std::cos(1.0), r * std::sin(1.0), ceiling);
        const auto found =
            support::irradiance(*method, {support::probe(scene, 1, point, -Vec3d::UnitZ(), 0)});
        EXPECT_NEAR(
            static_cast<double>(found.front().value.mean()) / on_ring(strength, angle, r, slope), 1,
            2e-5)
            << angle;
    }
}

// A mirror ring under a light on its axis; its inside sends light across the axis, its polygons are long.
TEST(SpecularPoints, TellAMirrorRing) {
    constexpr double light_z = 2, radius = 1, height = 0.5, albedo = 0.8;
    SceneDesc desc;
    Shape ring;
    ring.name = "ring";
    ring.primitive = Primitive::cylinder;
    ring.to_world = Eigen::Scaling(radius, radius, height);
    ring.flip_normals = true;
    ring.bsdf = support::mirror(static_cast<float>(albedo));
    desc.shapes = {ring, support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, light_z}, strength)};
    const Scene scene(std::move(desc));
    beamtree::BeamTreeParams params = of(beamtree::Intensity::refined, 24);
    params.max_bounces = 1;
    const auto method = build(scene, params, {});
    for (const double angle : {0.49, 0.52, 0.56, 0.58}) {
        // Down to the wall at 1, and on by the same slope to the floor: r = 1 - (z_wall tan a) < 1.
        const double r = 2 * radius - light_z * std::tan(angle);
        const double slope = light_z / (std::cos(angle) * std::cos(angle));
        const Vec3d point(r * std::cos(0.7), r * std::sin(0.7), 0);
        const auto found =
            support::irradiance(*method, {support::probe(scene, 1, point, Vec3d::UnitZ(), 0)});
        EXPECT_NEAR(static_cast<double>(found.front().value.mean()) /
                        (albedo * on_ring(strength, angle, r, slope)),
                    1, 2e-5)
            << angle;
    }
}

// A lamp in still water lights a ceiling.
TEST(SpecularPoints, TellStillWaterFromBelow) {
    constexpr double depth = 1, up = 2, index = 1.333;
    SceneDesc desc;
    desc.shapes = {support::horizontal("water", 0, 4, true, support::glass(1.333F)),
                   support::horizontal("ceiling", up, 9, false, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.3, -0.2, -depth}, strength)};
    const Scene scene(std::move(desc));
    const auto method = build(scene, of(beamtree::Intensity::refined, 64), {});
    const auto landing = [&](double a) {
        const double out = std::asin(index * std::sin(a));
        return depth * std::tan(a) + up * std::tan(out);
    };
    for (const double angle : {0.1, 0.3, 0.5, 0.6}) {
        const double r = landing(angle);
        const double slope = (landing(angle + 1e-6) - landing(angle - 1e-6)) / 2e-6;
        const double cosine = std::cos(std::asin(index * std::sin(angle)));
        // Fresnel's law is the same either way through the surface.
        const double passed = 1 - support::fresnel(cosine, index);
        const Vec3d point(0.3 + r * std::cos(2.0), -0.2 + r * std::sin(2.0), up);
        const auto found =
            support::irradiance(*method, {support::probe(scene, 1, point, -Vec3d::UnitZ(), 0)});
        EXPECT_NEAR(static_cast<double>(found.front().value.mean()) /
                        (passed * on_ring(strength, angle, r, slope)),
                    1, 2e-5)
            << angle;
    }
}

/// The flat meshes that are asked: quads of two triangles, with and without normals at their vertices.
std::vector<TriangleMesh> flat_squares() {
    std::vector<TriangleMesh> all;
    for (const int cells : {1, 2, 16}) {
        all.push_back(tessellate_rectangle(cells));
        all.push_back(support::flat(tessellate_rectangle(cells)));
    }
    return all;
}

/// The worst error at points round (x, y), all well inside the light.
template <typename Truth>
double worst_error(const Scene& scene, const CausticEstimator& method, const Vec3d& middle,
                   double radius, const Truth& truth) {
    constexpr int count = 200;
    double worst = 0;
    for (int i = 0; i < count; ++i) {
        const double r = radius * std::sqrt((i + 0.5) / count);
        const Vec3d p = middle + r * Vec3d(std::cos(2.4 * i), std::sin(2.4 * i), 0);
        const auto found = support::irradiance(
            method, {support::probe(scene, 1, p, Vec3d::UnitZ(), static_cast<std::uint64_t>(i))});
        const auto value = static_cast<double>(found.front().value.mean());
        worst = std::max(worst, std::abs(value / truth(p) - 1));
    }
    return worst;
}

beamtree::BeamTreeParams of(beamtree::PolygonKind polygons) {
    beamtree::BeamTreeParams params;
    params.polygons = polygons;
    params.max_bounces = 1;
    return params;
}

// A flat facet is a plane: what a tilted mirror of a mesh brings comes from the light's image.
TEST(SpecularPoints, TellFlatFacetsOfAMirror) {
    constexpr double albedo = 0.8, half = 1.6;
    const Vec3d middle(0, 0, 2), light(0, 0, 1);
    const Eigen::AngleAxisd turn(pi_d - 0.1, Vec3d(1, 2, 0).normalized());
    const Vec3d normal = turn * Vec3d::UnitZ();
    const Vec3d image = light - 2 * normal.dot(light - middle) * normal;
    const Transform to_world =
        Eigen::Translation3d(middle) * turn * Eigen::Scaling(half, half, 1.0);
    for (const TriangleMesh& mesh : flat_squares())
        for (const auto kind : {beamtree::PolygonKind::triangle, beamtree::PolygonKind::quad}) {
            SceneDesc desc;
            desc.shapes = {support::mesh("mirror", mesh, to_world,
                                         support::mirror(static_cast<float>(albedo))),
                           support::horizontal("floor", 0, 9, true, support::diffuse(0.5F))};
            desc.lights = {support::point_light(light, strength)};
            const Scene scene(std::move(desc));
            const double worst = worst_error(
                scene, *build(scene, of(kind), {}), Vec3d::Zero(), 2, [&](const Vec3d& p) {
                    return albedo * strength * image.z() / std::pow((image - p).norm(), 3);
                });
            EXPECT_LT(worst, 1e-5) << mesh.triangles.size() << ' ' << mesh.normals.size();
        }
}

TEST(SpecularPoints, TellFlatFacetsOfWater) {
    using namespace support::flat_pool;
    constexpr double height = 0.5;
    const Transform size(Eigen::Scaling(3.0, 3.0, 1.0));
    for (const TriangleMesh& mesh : flat_squares())
        for (const auto kind : {beamtree::PolygonKind::triangle, beamtree::PolygonKind::quad}) {
            SceneDesc desc;
            desc.shapes = {support::mesh("water", mesh, size, support::glass(1.333F)),
                           support::horizontal("floor", -depth, 9, true, support::diffuse(0.5F))};
            desc.lights = {
                support::point_light({0.013, 0.021, height}, static_cast<float>(intensity))};
            const Scene scene(std::move(desc));
            const Vec3d below(0.013, 0.021, -depth);
            const double worst = worst_error(
                scene, *build(scene, of(kind), {}), below, 1.5,
                [&](const Vec3d& p) { return floor_irradiance((p - below).norm(), height); });
            EXPECT_LT(worst, 1e-5) << mesh.triangles.size() << ' ' << mesh.normals.size();
        }
}

}  // namespace
}  // namespace caustics

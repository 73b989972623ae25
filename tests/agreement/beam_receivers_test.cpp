#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

// A mirror on the plane y = 1 and two lamps: the light at a point is that of the lamps' images, and
// arrives from them. Receivers of any shape and reflectance.
struct Lamp {
    Vec3d place;
    float intensity;
    Vec3d image() const { return {place.x(), 2 - place.y(), place.z()}; }
};
const Lamp lamps[] = {{{0.5, 0.25, 1}, 3}, {{-0.6, -0.3, 1.4}, 5}};

Scene with_receiver(Shape receiver) {
    SceneDesc desc;
    Shape mirror = support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, {});
    desc.shapes = {
        support::mesh("mirror", tessellate_rectangle(96), mirror.to_world, support::mirror()),
        std::move(receiver)};
    for (const Lamp& lamp : lamps)
        desc.lights.push_back(support::point_light(lamp.place, lamp.intensity));
    return Scene(std::move(desc));
}

/// What one lamp brings to a point by way of the mirror.
struct Arriving {
    double irradiance = 0;
    Vec3 wi = Vec3::UnitZ();
};

Arriving arriving(const Scene& scene, const ReceiverPoint& point, const Lamp& lamp) {
    const Vec3d p = point.position.cast<double>();
    const Vec3d to_image = lamp.image() - p;
    Arriving light;
    light.wi = to_image.normalized().cast<float>();
    const double cosine = point.geometric_normal.cast<double>().dot(to_image.normalized());
    const Vec3d crossing = p + (1 - p.y()) / to_image.y() * to_image;
    if (cosine <= 0 || std::abs(crossing.x()) > 1 || crossing.z() < 0 || crossing.z() > 2)
        return light;
    const SegmentEnd on_mirror{
        crossing.cast<float>(), Vec3::UnitY(),
        support::surface_offset(scene, 0, crossing.cast<float>(), Vec3::UnitY())};
    const SegmentEnd on_receiver{point.position, point.geometric_normal, point.offset};
    const SegmentEnd at_lamp{lamp.place.cast<float>()};
    if (scene.occluded(on_receiver, on_mirror) || scene.occluded(on_mirror, at_lamp)) return light;
    light.irradiance = static_cast<double>(lamp.intensity) * cosine / to_image.squaredNorm();
    return light;
}

// Receiver points as a camera above finds them, seen from where the first lamp's glint is.
std::vector<ReceiverPoint> points_from_above(const Scene& scene, double half) {
    std::vector<ReceiverPoint> points;
    Rng rng(21, Stage::test, 0);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 above(static_cast<float>(half) * (2 * rng.next() - 1),
                         static_cast<float>(half) * (2 * rng.next() - 1) - 0.3F, 3);
        const auto hit = scene.intersect({above, -Vec3::UnitZ()});
        if (!hit || hit->shape != 1) continue;
        const auto point = receiver_point(scene, *hit, Vec3::UnitZ());
        if (point) points.push_back(*point);
        if (!point) continue;
        const Vec3 wi =
            Vec3d(lamps[0].image() - point->position.cast<double>()).normalized().cast<float>();
        const Vec3 glint = 2 * point->shading_normal.dot(wi) * point->shading_normal - wi;
        if (glint.dot(point->geometric_normal) > 0.1F) points.back().wo = glint;
    }
    return points;
}

// Sums over all points: within a beam the light is even, which averages out.
void expect_closed_form(const Shape& receiver, const beamtree::BeamTreeParams& params) {
    const Scene scene = with_receiver(receiver);
    const auto method = build(scene, params, RunOptions{});
    const std::vector<ReceiverPoint> points = points_from_above(scene, 0.7);
    std::vector<Estimate> radiance(points.size());
    const auto context = method->make_context();
    method->radiance(points, radiance, *context);
    const std::vector<Estimate> irradiance = support::irradiance(*method, points);
    double sums[2] = {0, 0};
    double truths[2] = {0, 0};
    int lit = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        sums[0] += static_cast<double>(irradiance[i].value.mean());
        sums[1] += static_cast<double>(radiance[i].value.mean());
        for (const Lamp& lamp : lamps) {
            const Arriving light = arriving(scene, points[i], lamp);
            lit += light.irradiance > 0;
            truths[0] += light.irradiance;
            const Spectrum f = evaluate(*points[i].bsdf, points[i].uv, points[i].shading_normal,
                                        points[i].wo, light.wi);
            truths[1] += light.irradiance * static_cast<double>(f.mean());
        }
    }
    EXPECT_GT(lit, 1000) << receiver.name;
    EXPECT_NEAR(sums[0] / truths[0], 1, 0.005) << receiver.name;
    EXPECT_NEAR(sums[1] / truths[1], 1, 0.005) << receiver.name;
}

std::vector<beamtree::BeamTreeParams> both_leaves() {
    beamtree::BeamTreeParams n;
    beamtree::BeamTreeParams k;
    k.leaf = beamtree::BeamTreeParams::Leaf::fixed;
    return {n, k};
}

SineHeightfield bumps() {
    SineHeightfield field;
    field.waves = {{0.04, {9, 2}, 0.3}, {0.03, {-4, 8}, 1.1}};
    return field;
}

TEST(BeamReceivers, AreSeenByTheDirectionsThatLightArrivesAlong) {
    for (const beamtree::BeamTreeParams& params : both_leaves())
        for (const float alpha : {1.0F, 0.1F, 0.01F})
            expect_closed_form(
                support::horizontal("floor", 0, 2, true, support::schlick(0.6F, alpha)), params);
}

TEST(BeamReceivers, MayBeCurved) {
    for (const beamtree::BeamTreeParams& params : both_leaves())
        expect_closed_form(
            support::sphere("ball", {0.1, -0.3, 0.2}, 0.6, support::schlick(0.6F, 0.1F)), params);
}

TEST(BeamReceivers, MayBeBumpy) {
    Shape exact;
    exact.name = "bumps";
    exact.primitive = Primitive::heightfield;
    exact.field = bumps();
    exact.bsdf = support::schlick(0.6F, 0.1F);
    const Shape smooth = support::mesh("smooth mesh", tessellate_heightfield(bumps(), 24),
                                       Transform::Identity(), exact.bsdf);
    const Shape flat =
        support::mesh("flat mesh", support::flat(smooth.mesh), Transform::Identity(), exact.bsdf);
    for (const beamtree::BeamTreeParams& params : both_leaves())
        for (const Shape& receiver : {exact, smooth, flat}) expect_closed_form(receiver, params);
}

}  // namespace
}  // namespace caustics

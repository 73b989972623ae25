#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/tessellate.h"
#include "core/reference/light_trace.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/flat_pool.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

using namespace support::flat_pool;

constexpr double half_surface = 6;

constexpr std::size_t pool_floor = 0;

Scene pool(Shape water) {
    SceneDesc desc;
    water.bsdf = support::glass(static_cast<float>(index));
    desc.shapes = {support::horizontal("floor", -depth, 12, true, support::diffuse(0.5F)),
                   std::move(water)};
    desc.lights = {support::point_light({0, 0, height}, static_cast<float>(intensity))};
    return Scene(std::move(desc));
}

Shape exact_water() { return support::horizontal("water", 0, half_surface, true, {}); }

Shape tessellated_water(int resolution) {
    const Transform to_world(Eigen::Scaling(half_surface, half_surface, 1.0));
    return support::mesh("water", tessellate_rectangle(resolution), to_world, {});
}

Shape still_heightfield() {
    Shape shape;
    shape.name = "water";
    shape.primitive = Primitive::heightfield;
    shape.field.half_size = Vec2d::Constant(half_surface);
    return shape;
}

// Points on a circle of the floor, turned by the golden angle's share so that rings of different
// size do not line up.
std::vector<ReceiverPoint> ring(const Scene& scene, double r, int count, float radius) {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * pi_d * (i + 0.618 * r) / count;
        points.push_back(support::probe(scene, pool_floor,
                                        {r * std::cos(angle), r * std::sin(angle), -depth},
                                        Vec3d::UnitZ(), static_cast<std::uint64_t>(i), radius));
    }
    return points;
}

// Within 2 %. A ring of 60 discs of 200 photons is sure to 1/sqrt(198 * 60) = 0.9 % and less
// where they overlap; in the middle a ring of radius 0.15 stands for the centre.
void expect_photon_map_is_right(const Scene& scene) {
    photonmap::PhotonMapParams params;
    params.photons = 1'000'000;
    params.nearest = 200;
    const auto map = build(scene, params, RunOptions{});
    for (const double r : {0.15, 0.5, 1.0, 1.5, 2.0, 3.0}) {
        support::Moments found;
        for (const Estimate& e : support::irradiance(*map, ring(scene, r, 120, 0)))
            found.add(static_cast<double>(e.value.mean()));
        EXPECT_NEAR(found.mean() / floor_irradiance(r), 1, 0.02) << "r = " << r;
    }
}

void expect_light_trace_is_right(const Scene& scene) {
    const auto reference = build(scene, LightTraceParams{.paths = 700'000}, RunOptions{});
    const std::vector<double> radii = {0, 0.5, 1.0, 1.5, 2.0, 3.0};
    for (const double r : radii) {
        // 16 discs that do not overlap; their mean's error from their scatter.
        support::Moments found;
        const float radius = r == 0 ? 0.05F : static_cast<float>(0.15 * r);
        for (const Estimate& e :
             support::irradiance(*reference, ring(scene, r, r == 0 ? 1 : 16, radius))) {
            const auto error = static_cast<double>(e.standard_error.mean());
            const double z = (static_cast<double>(e.value.mean()) - floor_irradiance(r)) / error;
            EXPECT_LT(std::abs(z), support::sidak_bound(radii.size() * 16)) << "r = " << r;
            found.add(static_cast<double>(e.value.mean()));
        }
        if (r == 0) continue;
        EXPECT_NEAR(found.mean(), floor_irradiance(r), 4 * found.standard_error()) << "r = " << r;
    }
}

TEST(FlatPool, TheClosedFormConservesFlux) {
    // 2 pi int E r dr over the floor = 2 pi I int (1 - R) sin a da over the same cone.
    constexpr int steps = 20'000;
    const double last = std::atan(1.5);
    const double end = landing_radius(last);
    double arrived = 0;
    double sent = 0;
    for (int i = 0; i < steps; ++i) {
        const double r = end * (i + 0.5) / steps;
        arrived += floor_irradiance(r) * r * end / steps;
        const double a = last * (i + 0.5) / steps;
        sent += intensity * (1 - support::fresnel(std::cos(a), index)) * std::sin(a) * last / steps;
    }
    EXPECT_NEAR(arrived / sent, 1, 1e-6);
}

TEST(FlatPool, PhotonMapUnderAnExactSurface) { expect_photon_map_is_right(pool(exact_water())); }
TEST(FlatPool, PhotonMapUnderAMesh) { expect_photon_map_is_right(pool(tessellated_water(8))); }
TEST(FlatPool, LightTraceUnderAnExactSurface) { expect_light_trace_is_right(pool(exact_water())); }
TEST(FlatPool, LightTraceUnderAMesh) { expect_light_trace_is_right(pool(tessellated_water(8))); }
TEST(FlatPool, LightTraceUnderAStillHeightfield) {
    expect_light_trace_is_right(pool(still_heightfield()));
}

}  // namespace
}  // namespace caustics

#include "beamtree/light/beam_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

// A mean of rays that go apart is shorter than they are; a lobe about the mirrored direction must not show it. Seen from where
// the mirrored lamp's light is mirrored to, the lobe has its largest value, but for what rays between corners are off.
TEST(BeamLight, ArrivesByAUnitVector) {
    constexpr float exponent = 8;
    SceneDesc desc;
    const Transform facing_down(Eigen::Translation3d(0, 0, 1) *
                                Eigen::AngleAxisd(pi_d, Vec3d::UnitX()));
    desc.shapes = {support::mesh("mirror", tessellate_rectangle(8), facing_down, support::mirror()),
                   support::horizontal("floor", 0, 3, true, support::phong(0, 0.5F, exponent))};
    desc.lights = {support::point_light({0, 0, 0.3}, 1)};
    const Vec3 mirrored_lamp(0, 0, 1.7F);
    const Scene scene(std::move(desc));
    BeamTreeParams params;
    params.max_bounces = 1;
    params.intensity = Intensity::area;
    const auto estimator = build(scene, params, {});
    const auto context = estimator->make_context();
    double sum = 0;
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 10; ++j) {
            const Vec3d at(0.11 * i - 0.5, 0.13 * j - 0.6, 0);
            ReceiverPoint point = support::probe(scene, 1, at, Vec3d::UnitZ(), 0);
            const Vec3 wi = (mirrored_lamp - point.position).normalized();
            point.wo = Vec3(-wi.x(), -wi.y(), wi.z());
            Estimate radiance, irradiance;
            estimator->radiance(std::span(&point, 1), std::span(&radiance, 1), *context);
            estimator->irradiance(std::span(&point, 1), std::span(&irradiance, 1), *context);
            const float largest =
                evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, wi).mean();
            const float share = radiance.value.mean() / (largest * irradiance.value.mean());
            EXPECT_GT(share, 0.97F) << at.transpose();
            EXPECT_LT(share, 1.0001F) << at.transpose();
            sum += static_cast<double>(share);
        }
    EXPECT_GT(sum / 100, 0.995);
}

// A wall that mirrors, in strips 60 cm long and 27 mm high whose sides lie across the light, which passes along it: each
// triangle is a sliver, and light leaves it at a slant of 2 degrees. The floor has the light of the mirrored lamp.
TEST(BeamLight, LeavesSliversOfAFlatWallThatItPassesAlong) {
    TriangleMesh wall;
    constexpr int strips = 60;
    for (int i = 0; i <= strips; ++i)
        for (const float y : {-0.3F, 0.3F})
            wall.positions.emplace_back(0.0F, y, 0.3F + 1.6F * static_cast<float>(i) / strips);
    for (std::uint32_t i = 0; i < strips; ++i) {
        wall.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
        wall.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
    }
    SceneDesc desc;
    // Elsewhere and turned, so that corners are rounded.
    const Transform turned(Eigen::Translation3d(1.37, -0.41, 0) *
                           Eigen::AngleAxisd(0.7, Vec3d::UnitZ()));
    const auto placed = [&](double x, double y, double z) -> Vec3d {
        return turned * Vec3d(x, y, z);
    };
    desc.shapes = {support::mesh("wall", wall, turned, support::mirror()),
                   support::horizontal("floor", 0, 5, true, support::diffuse(0.5F))};
    const Vec3d lamp(0.1, 0, 3);
    desc.lights = {support::point_light(placed(lamp.x(), lamp.y(), lamp.z()), 1)};
    const Scene scene(std::move(desc));
    for (const float footprint : {0.0F, 0.004F}) {
        BeamTreeParams params;
        params.max_bounces = 1;
        params.footprint = footprint;
        const auto estimator = build(scene, params, {});
        for (int i = 0; i < 12; ++i)
            for (int j = 0; j < 5; ++j) {
                const Vec3d at(0.022 + 0.006 * i, -0.2 + 0.09 * j, 0);
                const Vec3d way = at - Vec3d(-lamp.x(), lamp.y(), lamp.z());
                const double expected = -way.z() / std::pow(way.norm(), 3);
                const ReceiverPoint point =
                    support::probe(scene, 1, placed(at.x(), at.y(), 0), Vec3d::UnitZ(), 0);
                const Estimate found = support::irradiance(*estimator, {point})[0];
                // Over a square, light is taken as linear in a polygon.
                EXPECT_NEAR(static_cast<double>(found.value[0]) / expected, 1,
                            footprint > 0 ? 0.02 : 0.001)
                    << at.transpose() << ", footprint " << footprint;
            }
    }
}

}  // namespace
}  // namespace caustics::beamtree

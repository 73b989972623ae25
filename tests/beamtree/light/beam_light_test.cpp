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

}  // namespace
}  // namespace caustics::beamtree

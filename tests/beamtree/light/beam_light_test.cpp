#include "beamtree/light/beam_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

// A mean of rays that go apart is shorter than they are; a lobe about the mirrored direction must not show it. By symmetry
// the light in the middle of two triangles arrives straight from above, where Phong's lobe has its largest value.
TEST(BeamLight, ArrivesByAUnitVector) {
    constexpr float exponent = 8;
    constexpr float specular = 0.5F;
    SceneDesc desc;
    const Transform facing_down(Eigen::Translation3d(0, 0, 1) *
                                Eigen::AngleAxisd(pi_d, Vec3d::UnitX()));
    desc.shapes = {support::mesh("mirror", tessellate_rectangle(1), facing_down, support::mirror()),
                   support::horizontal("floor", 0, 3, true, support::phong(0, specular, exponent))};
    desc.lights = {support::point_light({0, 0, 0.3}, 1)};
    const Scene scene(std::move(desc));
    BeamTreeParams params;
    params.max_bounces = 1;
    params.intensity = Intensity::area;
    const auto estimator = build(scene, params, {});
    ReceiverPoint point = support::probe(scene, 1, {0, 0, 0}, Vec3d::UnitZ(), 0);
    point.wo = Vec3::UnitZ();
    const auto context = estimator->make_context();
    Estimate radiance;
    Estimate irradiance;
    estimator->radiance(std::span(&point, 1), std::span(&radiance, 1), *context);
    estimator->irradiance(std::span(&point, 1), std::span(&irradiance, 1), *context);
    ASSERT_GT(irradiance.value.mean(), 0);
    const float largest =
        evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, Vec3::UnitZ()).mean();
    EXPECT_NEAR(largest, specular * (exponent + 2) / (2 * pi), 1e-5F);
    EXPECT_NEAR(radiance.value.mean() / (largest * irradiance.value.mean()), 1, 1e-4F);
}

}  // namespace
}  // namespace caustics::beamtree

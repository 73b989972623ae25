#include "beamtree/beams/area_light_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "beamtree/beam_tree.h"
#include "beamtree/beams/light_sample.h"
#include "core/geometry/exact_shape.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics::beamtree {
namespace {

constexpr int seeds = 20;

/// A lamp below a level mirror, above a floor.
SceneDesc lamp_below_a_mirror(const Shape& lamp) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", 1.5, 1, false, support::mirror()),
                   support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)), lamp};
    desc.shapes.back().radiance = Spectrum::Constant(2);
    return desc;
}

Transform placed(const Vec3d& at, double size) {
    return Transform(Eigen::Translation3d(at) * Eigen::Scaling(size));
}

Shape cylinder() {
    Shape shape;
    shape.name = "tube";
    shape.primitive = Primitive::cylinder;
    shape.to_world = placed({-0.4, 0.1, 0.6}, 0.2);
    shape.to_world.rotate(Eigen::AngleAxisd(1.3, Vec3d::UnitY()));
    shape.bsdf = support::diffuse(0);
    return shape;
}

double irradiance(const std::vector<LightSample>& samples, const Vec3& point, const Vec3& normal) {
    double sum = 0;
    for (const LightSample& sample : samples) {
        const Vec3 w = to_light(sample, point);
        sum += static_cast<double>(strength_along(sample, w).mean() * normal.dot(w) /
                                   (sample.position - point).squaredNorm());
    }
    return sum;
}

// By very many points all over the lamp.
double true_irradiance(const Scene& scene, const Vec3& point, const Vec3& normal) {
    const auto& light = std::get<AreaLight>(scene.lights()[0]);
    double sum = 0;
    constexpr int side = 700;
    for (int i = 0; i < side * side; ++i) {
        const auto sample = light.sampler.sample(scene.shapes()[light.shape],
                                                 (static_cast<float>(i / side) + 0.5F) / side,
                                                 (static_cast<float>(i % side) + 0.5F) / side);
        const Vec3 towards = sample.position - point;
        const float distance = towards.norm();
        sum += static_cast<double>(std::max(0.0F, -sample.normal.dot(towards)) *
                                   normal.dot(towards) / std::pow(distance, 4.0F));
    }
    return sum * light.sampler.area() * static_cast<double>(light.radiance.mean()) / (side * side);
}

// Points of the lamp's square, 32 x 32 cells of even area, come as often as the weight that they bring says,
// and the weights' inverses make up the whole.
TEST(AreaLightSampler, SamplesFollowTheDensityThatTheirWeightsTell) {
    constexpr std::size_t side = 32;
    constexpr int draws = 200'000;
    for (const Shape& lamp :
         {support::sphere("ball", {0.3, 0, 0.6}, 0.2, support::diffuse(0)), cylinder()}) {
        const Scene scene(lamp_below_a_mirror(lamp));
        const auto& light = std::get<AreaLight>(scene.lights()[0]);
        const AreaLightSampler sampler(scene, light);
        const Shape& shape = scene.shapes()[light.shape];
        const Transform to_local = shape.to_world.inverse();
        std::vector<double> counts(side * side), density(side * side);
        Rng rng(1, Stage::test, 0);
        for (int i = 0; i < draws; ++i) {
            const float u0 = rng.next();
            const AreaLightSampler::Sample sample = sampler.sample(u0, rng.next());
            Vec2d uv = exact_uv(shape, to_local * sample.position.cast<double>()).cast<double>();
            if (shape.primitive == Primitive::sphere) uv.y() = (1 - std::cos(pi_d * uv.y())) / 2;
            const auto cell = [](double u) {
                return static_cast<std::size_t>(std::clamp(u, 0.0, 0.999999) * side);
            };
            const std::size_t at = cell(uv.x()) * side + cell(uv.y());
            counts[at] += 1;
            density[at] += 1 / static_cast<double>(sample.weight);
        }
        std::vector<double> expected;
        for (std::size_t i = 0; i < counts.size(); ++i)
            expected.push_back(counts[i] > 0 ? draws / double{side * side} * density[i] / counts[i]
                                             : 0);
        EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), draws, 0.01 * draws);
        EXPECT_GT(support::chi_square_p_value(counts, expected), 1e-3) << lamp.name;
    }
}

// Sixteen points of a lamp tell what it shines onto a caster: right on average, and nearly right each
// time.
TEST(AreaLightSampler, ShinesOnCastersAsTheWholeLamp) {
    const Vec3d at(0.3, 0, 0.6);
    const std::vector<Shape> lamps = {
        support::sphere("ball", at, 0.2, support::diffuse(0)), cylinder(),
        support::mesh("mesh", tessellate_sphere(10), placed(at, 0.2), support::diffuse(0)),
        support::rectangle("flat", at, {0.2, 0, 0}, {0, 0.2, 0.05}, support::diffuse(0))};
    for (const Shape& lamp : lamps) {
        const Scene scene(lamp_below_a_mirror(lamp));
        for (const Vec3& point : {Vec3(0.3F, 0, 1.5F), Vec3(-0.5F, 0.4F, 1.5F)}) {
            const double truth = true_irradiance(scene, point, -Vec3::UnitZ());
            double squares = 0;
            for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
                const double few =
                    irradiance(sample_lights(scene, 16, seed), point, -Vec3::UnitZ());
                squares += std::pow(few / truth - 1, 2) / seeds;
            }
            EXPECT_LT(std::sqrt(squares), lamp.name == "mesh" ? 0.12 : 0.075)
                << lamp.name << ", " << point.transpose();
            const double many = irradiance(sample_lights(scene, 4096, 1), point, -Vec3::UnitZ());
            EXPECT_NEAR(many / truth, 1, 0.01) << lamp.name << ", " << point.transpose();
        }
    }
}

// The sphere's image in the mirror lights the floor by pi L (r / d)^2 cos.
TEST(AreaLightSampler, ASphereInAMirrorIsAsBrightAsItsImage) {
    const double radius = 0.1;
    const Scene scene(
        lamp_below_a_mirror(support::sphere("lamp", {0.3, 0, 0.6}, radius, support::diffuse(0))));
    const Vec3d image(0.3, 0, 2.4);
    std::vector<ReceiverPoint> points;
    double truth = 0;
    for (int i = 0; i < 40; ++i) {
        const double angle = 0.157 * i;
        const Vec3d p(0.3 + 1.1 * std::cos(angle), 1.1 * std::sin(angle), 0);
        points.push_back(support::probe(scene, 1, p, Vec3d::UnitZ(), 0));
        const double distance = (image - p).norm();
        truth += pi_d * 2 * radius * radius * image.z() / std::pow(distance, 3);
    }
    BeamTreeParams params;
    params.mesh_resolution = 16;
    const auto ratio = [&](int light_samples, std::uint64_t seed) {
        params.light_samples = light_samples;
        RunOptions options;
        options.seed = seed;
        double sum = 0;
        for (const Estimate& e : support::irradiance(*build(scene, params, options), points))
            sum += static_cast<double>(e.value.mean());
        return sum / truth;
    };
    for (std::uint64_t seed = 1; seed <= 4; ++seed) EXPECT_NEAR(ratio(16, seed), 1, 0.07) << seed;
    EXPECT_NEAR(ratio(128, 1), 1, 0.015);
}

}  // namespace
}  // namespace caustics::beamtree

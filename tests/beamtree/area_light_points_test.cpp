#include "beamtree/beams/area_light_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "beamtree/beam_tree.h"
#include "beamtree/beams/light_sample.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics::beamtree {
namespace {

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

/// Of a part of a lamp, in its area and radiance.
double arriving(const Vec3& position, const Vec3& lamp_normal, const Vec3& point,
                const Vec3& normal) {
    const Vec3 towards = position - point;
    return static_cast<double>(std::max(0.0F, -lamp_normal.dot(towards)) * normal.dot(towards) /
                               std::pow(towards.norm(), 4.0F));
}

// By very many points all over a triangle.
double true_sum(const std::array<Vec3, 3>& corners, const Vec3& point, const Vec3& normal,
                int side) {
    const auto& [a, b, c] = corners;
    const Vec3 cross = (b - a).cross(c - a);
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < 2 * (side - i) - 1; ++j) {
            const float third = j % 2 == 0 ? 1.0F / 3 : 2.0F / 3;
            const float u = (static_cast<float>(i) + third) / static_cast<float>(side);
            const float v = (static_cast<float>(j / 2) + third) / static_cast<float>(side);
            sum += arriving(a + u * (b - a) + v * (c - a), cross.normalized(), point, normal);
        }
    return sum * static_cast<double>(cross.norm()) / (2 * side * side);
}

// By very many points all over the lamp.
double true_irradiance(const Scene& scene, const Vec3& point, const Vec3& normal) {
    const auto& light = std::get<AreaLight>(scene.lights()[0]);
    const Shape& shape = scene.shapes()[light.shape];
    const auto radiance = static_cast<double>(light.radiance.mean());
    const TriangleMesh& mesh = shape.mesh;
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += true_sum({mesh.positions[a], mesh.positions[b], mesh.positions[c]}, point, normal,
                        mesh.triangles.size() < 100 ? 100 : 6);
    if (!mesh.triangles.empty()) return sum * radiance;
    constexpr int side = 700;
    for (int i = 0; i < side * side; ++i) {
        const auto sample =
            light.sampler.sample(shape, (static_cast<float>(i / side) + 0.5F) / side,
                                 (static_cast<float>(i % side) + 0.5F) / side);
        sum += arriving(sample.position, sample.normal, point, normal);
    }
    return sum * light.sampler.area() * radiance / (side * side);
}

/// A ball of triangles.
Shape mesh_ball(const Vec3d& at, double radius, int resolution) {
    return support::mesh("mesh", tessellate_sphere(resolution), placed(at, radius),
                         support::diffuse(0));
}

/// Of eight faces, four of which see no more of a mirror than its rim.
Shape octahedron(const Vec3d& at) {
    Shape shape = mesh_ball(at, 0.25, 2);
    shape.name = "octahedron";
    return shape;
}

/// The same triangles in another order.
Shape shuffled(Shape shape) {
    shape.name = "shuffled";
    Rng rng(5, Stage::test, 1);
    auto& all = shape.mesh.triangles;
    for (std::size_t i = all.size() - 1; i > 0; --i)
        std::swap(all[i], all[static_cast<std::size_t>(rng.next_fine() * static_cast<double>(i))]);
    return shape;
}

std::vector<Shape> curved_lamps() {
    const Vec3d at(0.3, 0, 0.6);
    return {support::sphere("ball", at, 0.2, support::diffuse(0)), cylinder(),
            mesh_ball(at, 0.2, 24), shuffled(mesh_ball(at, 0.2, 24)), octahedron(at)};
}

/// What points draw of the truth, over many seeds.
support::Moments shares(const Scene& scene, const Vec3& point, int count, std::uint64_t draws) {
    const double truth = true_irradiance(scene, point, -Vec3::UnitZ());
    support::Moments moments;
    for (std::uint64_t seed = 1; seed <= draws; ++seed)
        moments.add(irradiance(sample_lights(scene, count, seed), point, -Vec3::UnitZ()) / truth);
    return moments;
}

// Four standard errors, and what the sum that is taken for the truth is off.
TEST(AreaLightPoints, AreRightOnAverageAtAnyNumber) {
    for (const Shape& lamp : curved_lamps()) {
        const Scene scene(lamp_below_a_mirror(lamp));
        for (const int count : {1, 3, 16, 40}) {
            const support::Moments found = shares(scene, {-0.5F, 0.4F, 1.5F}, count, 25);
            EXPECT_NEAR(found.mean(), 1, 4 * found.standard_error() + 5e-4)
                << lamp.name << ' ' << count;
        }
    }
}

// Sixteen points of a lamp tell what it shines onto a caster. A lattice weighted by the same light has three times
// this spread, and over a mesh up to ten times.
TEST(AreaLightPoints, ShineOnCastersAsTheWholeLampWithSixteen) {
    for (const Shape& lamp : curved_lamps()) {
        const Scene scene(lamp_below_a_mirror(lamp));
        for (const Vec3& point : {Vec3(0.3F, 0, 1.5F), Vec3(-0.5F, 0.4F, 1.5F)})
            EXPECT_LT(shares(scene, point, 16, 20).deviation(), 0.05)
                << lamp.name << ", " << point.transpose();
    }
}

// A lamp below a mirror twelve metres wide, as the mirror's images of two places see it.
TEST(AreaLightPoints, ShineOnAWideMirrorAsTheWholeLampWithSixteen) {
    const Vec3d at(3, 0, 1);
    for (const Shape& lamp :
         {support::sphere("ball", at, 0.3, support::diffuse(0)), mesh_ball(at, 0.3, 24)}) {
        SceneDesc desc;
        desc.shapes = {support::horizontal("mirror", 2, 6, false, support::mirror()),
                       support::horizontal("floor", 0, 8, true, support::diffuse(0.5F)), lamp};
        desc.shapes.back().radiance = Spectrum::Constant(5);
        const Scene scene(std::move(desc));
        for (const Vec3& point : {Vec3(3, 0, 4), Vec3(0, 0, 4)}) {
            const support::Moments found = shares(scene, point, 16, 25);
            EXPECT_LT(found.deviation(), 0.06) << lamp.name << ", " << point.transpose();
            EXPECT_NEAR(found.mean(), 1, 4 * found.standard_error() + 5e-4)
                << lamp.name << ", " << point.transpose();
        }
    }
}

TEST(AreaLightPoints, ComeCloserWithTheirNumber) {
    for (const Shape& lamp : curved_lamps()) {
        const Scene scene(lamp_below_a_mirror(lamp));
        const Vec3 point(-0.5F, 0.4F, 1.5F);
        EXPECT_LT(shares(scene, point, 256, 5).deviation(), 0.01) << lamp.name;
    }
}

// The sphere's image in the mirror lights the floor by pi L (r / d)^2 cos.
TEST(AreaLightPoints, ASphereInAMirrorIsAsBrightAsItsImage) {
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
    for (std::uint64_t seed = 1; seed <= 4; ++seed) EXPECT_NEAR(ratio(16, seed), 1, 0.03) << seed;
    // So many points are left to pencils, of which each seed has 1 % of noise.
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) mean += ratio(128, seed) / 4;
    EXPECT_NEAR(mean, 1, 0.01);
}

}  // namespace
}  // namespace caustics::beamtree

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics {
namespace {

// Every choice of the beam tree against formulas, point by point, within 0.5 %.
std::vector<beamtree::BeamTreeParams> all_params() {
    std::vector<beamtree::BeamTreeParams> all;
    for (const auto leaf :
         {beamtree::BeamTreeParams::Leaf::receiver, beamtree::BeamTreeParams::Leaf::fixed})
        for (const beamtree::Bound bound :
             {beamtree::Bound::single, beamtree::Bound::double_cone, beamtree::Bound::hybrid,
              beamtree::Bound::sphere_swept}) {
            beamtree::BeamTreeParams params;
            params.leaf = leaf;
            params.bound = bound;
            params.mesh_resolution = 48;
            all.push_back(params);
        }
    return all;
}

double value(const CausticEstimator& method, const ReceiverPoint& point) {
    return static_cast<double>(support::irradiance(method, {point})[0].value.mean());
}

// A beam's light is even over its caustic polygon, so that a point is off by the field's slope times
// the polygon's size; a mean over cells of floor is off by its square. Means of the method and of
// the truth over a square cell of 0.15 m, 12 x 12 points.
constexpr int cell_points = 12;

template <typename Truth>
void expect_cell(const Scene& scene, const CausticEstimator& method, const Vec3d& middle,
                 const Truth& truth) {
    double found = 0;
    double expected = 0;
    for (int i = 0; i < cell_points; ++i)
        for (int j = 0; j < cell_points; ++j) {
            const Vec3d p = middle + 0.15 * Vec3d((i + 0.5) / cell_points - 0.5,
                                                  (j + 0.5) / cell_points - 0.5, 0);
            found += value(method, support::probe(scene, 0, p, Vec3d::UnitZ(), 0));
            expected += truth(p);
        }
    EXPECT_NEAR(found / expected, 1, 0.005) << middle.transpose();
}

// The mirror |x| <= 1, 0 <= z <= 2 of the plane y = 1 over the floor z = 0: light comes from the
// image S' of the light, E = I n.w / |S' - p|^2 where the segment crosses the mirror.
const Vec3d lamp_position(0.5, 0.25, 1);
constexpr double lamp_intensity = 3;

double mirrored(const Vec3d& p, const Vec3d& normal) {
    const Vec3d to_image = Vec3d(lamp_position.x(), 2 - lamp_position.y(), lamp_position.z()) - p;
    const double t = (1 - p.y()) / to_image.y();
    const Vec3d crossing = p + t * to_image;
    if (t <= 0 || t >= 1 || std::abs(crossing.x()) > 1 || crossing.z() < 0 || crossing.z() > 2)
        return 0;
    return lamp_intensity * to_image.dot(normal) / std::pow(to_image.norm(), 3);
}

Scene beam_mirror_scene(const Bsdf& bsdf, bool mesh) {
    SceneDesc desc;
    Shape mirror = support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, bsdf);
    if (mesh) mirror = support::mesh("mirror", tessellate_rectangle(48), mirror.to_world, bsdf);
    desc.shapes = {support::horizontal("floor", 0, 6, true, support::diffuse(0.5F)), mirror,
                   support::sphere("ball", {0.2, -0.4, 0.5}, 0.3, support::diffuse(0.5F))};
    desc.lights = {support::point_light(lamp_position, static_cast<float>(lamp_intensity))};
    return Scene(std::move(desc));
}

bool in_the_balls_shadow(const Vec3d& p) {
    const Vec3d image(lamp_position.x(), 2 - lamp_position.y(), lamp_position.z());
    const Vec3d w = (image - p).normalized();
    const Vec3d to_ball = Vec3d(0.2, -0.4, 0.5) - p;
    const double along = to_ball.dot(w);
    return along > 0 && (to_ball - along * w).norm() < 0.42;
}

TEST(BeamFlatMirror, IsTheMethodOfImages) {
    for (const bool mesh : {false, true}) {
        const Scene scene = beam_mirror_scene(support::mirror(), mesh);
        for (const beamtree::BeamTreeParams& params : all_params()) {
            const auto method = build(scene, params, RunOptions{});
            for (int i = 0; i < 24; ++i) {
                const Vec3d p(-0.3 + 0.2 * (i % 6), -0.6 + 0.35 * (i / 6), 0);
                if (!in_the_balls_shadow(p))
                    expect_cell(scene, *method, p,
                                [](const Vec3d& q) { return mirrored(q, Vec3d::UnitZ()); });
            }
            for (const Vec3d& dark : {Vec3d(-4, 0, 0), Vec3d(0, 2, 0), Vec3d(4, 0.5, 0)})
                EXPECT_EQ(value(*method, support::probe(scene, 0, dark, Vec3d::UnitZ(), 0)), 0);
        }
    }
}

// A receiver that is not polygonised: the ball, whose normal is another at every point.
TEST(BeamFlatMirror, LightsACurvedReceiver) {
    const Scene scene = beam_mirror_scene(support::mirror(), false);
    const Vec3d image(lamp_position.x(), 2 - lamp_position.y(), lamp_position.z());
    for (const beamtree::BeamTreeParams& params : all_params()) {
        const auto method = build(scene, params, RunOptions{});
        int lit = 0;
        double sum = 0;
        double expected = 0;
        for (int i = 0; i < 600; ++i) {
            const double z = -0.9 + 1.8 * i / 600;
            const double r = std::sqrt(1 - z * z);
            const Vec3d n(r * std::cos(2.4 * i), r * std::sin(2.4 * i), z);
            const Vec3d p = Vec3d(0.2, -0.4, 0.5) + 0.3 * n;
            const double found = value(*method, support::probe(scene, 2, p, n, 0));
            const double cosine = n.dot((image - p).normalized());
            if (cosine < -0.01) {
                EXPECT_EQ(found, 0);
            }
            if (cosine < 0.1) continue;
            ++lit;
            sum += found;
            expected += mirrored(p, n);
        }
        EXPECT_GT(lit, 160);
        EXPECT_NEAR(sum / expected, 1, 0.005);
    }
}

TEST(BeamFlatMirror, AGlassSheetReflectsByFresnel) {
    const Scene scene = beam_mirror_scene(support::glass(1.5F), false);
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 48;
    const auto method = build(scene, params, RunOptions{});
    for (int i = 0; i < 24; ++i) {
        const Vec3d p(-0.3 + 0.2 * (i % 6), -0.6 + 0.35 * (i / 6), 0);
        if (in_the_balls_shadow(p)) continue;
        expect_cell(scene, *method, p, [](const Vec3d& q) {
            const Vec3d to_image = Vec3d(0.5, 1.75, 1) - q;
            return mirrored(q, Vec3d::UnitZ()) *
                   support::fresnel(to_image.y() / to_image.norm(), 1.5);
        });
    }
}

// 64 samples of a square light against 16 x 16 images of points.
TEST(BeamFlatMirror, AnAreaLightIsTheSumOfItsSamples) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 6, true, support::diffuse(0.5F)),
                   support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, support::mirror()),
                   support::rectangle("light", lamp_position, {0, 0, 0.15}, {0.15, 0, 0},
                                      support::diffuse(0))};
    desc.shapes[2].radiance = Spectrum(Spectrum::Constant(20));
    const Scene scene(desc);
    beamtree::BeamTreeParams params;
    params.light_samples = 64;
    params.mesh_resolution = 96;
    params.rest = beamtree::BeamTreeParams::Rest::max_beams;
    const auto method = build(scene, params, RunOptions{});
    for (int i = 0; i < 8; ++i) {
        const Vec3d middle(-0.3 + 0.3 * (i % 4), -0.6 + 0.6 * (i / 4), 0);
        expect_cell(scene, *method, middle, [](const Vec3d& p) {
            double truth = 0;
            constexpr int n = 16;
            for (int a = 0; a < n; ++a)
                for (int b = 0; b < n; ++b) {
                    const Vec3d to_image = Vec3d(0.5 + 0.15 * ((2 * a + 1.0) / n - 1), 1.75,
                                                 1 + 0.15 * ((2 * b + 1.0) / n - 1)) -
                                           p;
                    truth += 20 * to_image.z() * to_image.y() /
                             std::pow(to_image.squaredNorm(), 2) * std::pow(0.3 / n, 2);
                }
            return truth;
        });
    }
}

// A point light at height H above still water over a floor at depth D: see flat_pool_test.
constexpr double lamp_height = 2;
constexpr double water_depth = 1;
constexpr double water_index = 1.333;

double absorbed_floor_irradiance(double r, double absorption) {
    double low = 0;
    double high = pi_d / 2 - 1e-9;
    const auto landing = [](double a) {
        return lamp_height * std::tan(a) +
               water_depth * std::tan(std::asin(std::sin(a) / water_index));
    };
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (landing(middle) < r ? low : high) = middle;
    }
    const double cos_a = std::cos(low);
    const double cos_b = support::refracted_cosine(cos_a, water_index);
    const double slope =
        lamp_height / (cos_a * cos_a) + water_depth * cos_a / (water_index * std::pow(cos_b, 3));
    return 10 * (1 - support::fresnel(cos_a, water_index)) * std::sin(low) / (r * slope) *
           std::exp(-absorption * water_depth / cos_b);
}

TEST(BeamFlatPool, IsTheClosedForm) {
    const float absorption = 0.4F;
    for (const bool mesh : {false, true}) {
        SceneDesc desc;
        Shape water = support::horizontal("water", 0, 6, true, {});
        if (mesh) water = support::mesh("water", tessellate_rectangle(48), water.to_world, {});
        water.bsdf =
            support::glass(static_cast<float>(water_index), 1, Spectrum::Constant(absorption));
        desc.shapes = {support::horizontal("floor", -water_depth, 12, true, support::diffuse(0.5F)),
                       water};
        desc.lights = {support::point_light({0, 0, lamp_height}, 10)};
        const Scene scene(std::move(desc));
        for (beamtree::BeamTreeParams params : all_params()) {
            params.mesh_resolution = 48;
            const auto method = build(scene, params, RunOptions{});
            for (const double r : {0.0, 0.5, 1.0, 2.0, 3.0})
                expect_cell(scene, *method, {r * 0.8, r * 0.6, -water_depth}, [&](const Vec3d& p) {
                    return absorbed_floor_irradiance(p.head<2>().norm(),
                                                     static_cast<double>(absorption));
                });
        }
    }
}

// A lamp on the floor lights a mirror above: E = I 2H / |p - S'|^3 from its image S' at 2H. What
// it lies on does not hide it.
TEST(BeamFlat, LampOnTheFloor) {
    constexpr double above = 2;
    const Vec3d lamp(0.013, 0.021, 0);
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::horizontal("mirror", above, 1.5, false, support::mirror())};
    desc.lights = {support::point_light(lamp, static_cast<float>(lamp_intensity))};
    const Scene scene(std::move(desc));
    beamtree::BeamTreeParams params;
    params.mesh_resolution = 48;
    const auto method = build(scene, params, RunOptions{});
    for (const double x : {-0.9, -0.2, 0.3, 1.1})
        expect_cell(scene, *method, {x, 0.4 * x, 0}, [&](const Vec3d& p) {
            return lamp_intensity * 2 * above /
                   std::pow((p - lamp).squaredNorm() + 4 * above * above, 1.5);
        });
}

}  // namespace
}  // namespace caustics

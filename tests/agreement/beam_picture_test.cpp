#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/geometry/tessellate.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"
#include "tests/support/light_flux.h"
#include "tests/support/sanitizers.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

void add_floor_and_walls(SceneDesc& desc, const Bsdf& bsdf) {
    desc.shapes.push_back(support::horizontal("floor", -1, 1, true, bsdf));
    for (int i = 0; i < 4; ++i) {
        const Vec3d normal = (i % 2 == 0 ? 1.0 : -1.0) * Vec3d::Unit(i / 2);
        desc.shapes.push_back(
            support::rectangle("wall" + std::to_string(i), -normal + Vec3d(0, 0, -0.5),
                               normal.cross(Vec3d(0, 0, 1)), Vec3d(0, 0, 0.5), bsdf));
    }
}

SceneDesc pool_mesh(int resolution) {
    SineHeightfield field;
    field.waves = {{0.024, {7.1, 2.3}, 0.4}, {0.019, {-4.2, 8.6}, 1.9}};
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_heightfield(field, resolution),
                                 Transform::Identity(), support::glass(1.333F))};
    add_floor_and_walls(desc, support::schlick(0.6F, 0.4F));
    desc.lights = {support::point_light({0.4, 0.3, 2.5}, 10)};
    desc.camera = support::camera({0, -0.8, -0.15}, {0, 0.2, -0.9}, {0, 0, 1}, 75, 40, 40);
    return desc;
}

SceneDesc ring(int resolution) {
    SceneDesc desc;
    desc.shapes = {
        support::mesh("ring", tessellate_cylinder(resolution),
                      Transform(Eigen::Translation3d(0, 0, 0.01) * Eigen::Scaling(0.5, 0.5, 0.25)),
                      support::mirror()),
        support::horizontal("floor", 0, 1.2, true, support::schlick(0.7F, 0.3F))};
    desc.lights = {support::point_light({0, 0.49, 0.4}, 1)};
    desc.camera = support::camera({0, -1.1, 1.5}, {0, 0, 0}, {0, 0, 1}, 36, 40, 40);
    return desc;
}

template <typename Params>
std::vector<float> caustic_layer(const Scene& scene, const Params& params, int threads = 2) {
    RunOptions options;
    options.samples_per_pixel = 4;
    options.threads = threads;
    const auto method = build(scene, params, options);
    const Film film = render(scene, *method, options).film;
    return *film.find("caustic.G");
}

// [CC95]: "the caustic component for each pixel will be the same as that obtained by Watt's method".
// Flat receivers, whatever their polygons: equal to rounding. A point on the rim of a caustic
// polygon may fall to the other side of it.
void expect_equal(const Scene& scene,
                  beamtree::PolygonKind kind = beamtree::PolygonKind::triangle) {
    beamtree::BeamTreeParams tree_params = beamtree::BeamTreeParams::chuang1995();
    tree_params.polygons = kind;
    const std::vector<float> tree = caustic_layer(scene, tree_params);
    for (const int resolution : {2, 9}) {
        beamtree::CausticPolygonsParams params;
        params.polygons = kind;
        params.receiver_resolution = resolution;
        const std::vector<float> polygons = caustic_layer(scene, params);
        ASSERT_EQ(tree.size(), polygons.size());
        int lit = 0;
        int different = 0;
        for (std::size_t i = 0; i < tree.size(); ++i) {
            lit += tree[i] > 0;
            different += std::abs(tree[i] - polygons[i]) > 1e-4F * tree[i] + 1e-7F;
        }
        EXPECT_GT(lit, 400);
        EXPECT_LE(different, 4);
    }
}

TEST(BeamPicture, TreeAndCausticPolygonsAgreePerPixelInAPool) {
    expect_equal(Scene(pool_mesh(32)));
}
TEST(BeamPicture, TreeAndCausticPolygonsAgreePerPixelByQuads) {
    expect_equal(Scene(pool_mesh(24)), beamtree::PolygonKind::quad);
}
TEST(BeamPicture, TreeAndCausticPolygonsAgreePerPixelInARing) { expect_equal(Scene(ring(16))); }

TEST(BeamPicture, IsTheSameFromAnyNumberOfThreads) {
    const Scene scene(pool_mesh(24));
    EXPECT_EQ(caustic_layer(scene, beamtree::BeamTreeParams{}, 1),
              caustic_layer(scene, beamtree::BeamTreeParams{}, 3));
    EXPECT_EQ(caustic_layer(scene, beamtree::CausticPolygonsParams{}, 1),
              caustic_layer(scene, beamtree::CausticPolygonsParams{}, 3));
}

double sum(const std::vector<float>& values) {
    double total = 0;
    for (const float value : values) total += static_cast<double>(value);
    return total;
}

// Fixed planes bend the polygons' rims, and quads even out their halves, to second order only.
TEST(BeamPicture, FixedPlanesAndQuadsGiveTheSameLight) {
    const Scene scene(pool_mesh(64));
    const double usual = sum(caustic_layer(scene, beamtree::BeamTreeParams{}));
    beamtree::BeamTreeParams fixed;
    fixed.leaf = beamtree::BeamTreeParams::Leaf::fixed;
    EXPECT_NEAR(sum(caustic_layer(scene, fixed)) / usual, 1, 0.01);
    beamtree::BeamTreeParams quads;
    quads.polygons = beamtree::PolygonKind::quad;
    EXPECT_NEAR(sum(caustic_layer(scene, quads)) / usual, 1, 0.01);
}

/// Photons with one specular event, counted in 16 x 16 cells of the floor |x|, |y| <= half.
support::ArrivedFlux one_event_cells(const Scene& scene, double half, std::uint64_t paths) {
    const AimedEmission emission(scene);
    return support::arrived_flux(
        scene, support::aimed(emission), paths, 256,
        [&scene, half](const Deposit& deposit) {
            const Vec2d at = deposit.position.head<2>().cast<double>() / (2 * half);
            if (scene.shapes()[deposit.shape].name != "floor" || at.cwiseAbs().maxCoeff() >= 0.5)
                return -1;
            return static_cast<int>(16 * (at.x() + 0.5)) +
                   16 * static_cast<int>(16 * (at.y() + 0.5));
        },
        3, 1);
}

// The same mesh seen by photons, counted without any kernel, and by beams, sampled at random in
// each cell: z-scores of the cells' flux are unremarkable, those of dark cells too, where any light
// would have leaked. The limit of a thousandth of the cells' mean flux is left to what beams take as
// even over a polygon.
void expect_same_light(const Scene& scene, std::size_t floor, double half) {
    const support::ArrivedFlux photons =
        one_event_cells(scene, half, static_cast<std::uint64_t>(support::repetitions(2'000'000)));
    const auto method = [&] {
        beamtree::BeamTreeParams params;
        params.max_bounces = 1;
        return build(scene, params, RunOptions{});
    }();
    const double side = half / 8;
    const double height = static_cast<double>(bounds(scene.shapes()[floor]).max().z());
    const double mean_flux = photons.total() / 256;
    double largest = 0;
    double squares = 0;
    int bright = 0;
    for (int cell = 0; cell < 256; ++cell) {
        const auto index = static_cast<std::size_t>(cell);
        Rng rng(9, Stage::test, index);
        support::Moments irradiance;
        std::vector<ReceiverPoint> points;
        const bool dark = photons.mean[index] < 0.05 * mean_flux;
        const int n = support::sanitized || dark ? 8 : 32;
        for (int i = 0; i < n * n; ++i) {
            const double u = (i % n + static_cast<double>(rng.next())) / n;
            const double v = (i / n + static_cast<double>(rng.next())) / n;
            const Vec3d p(side * (cell % 16 + u) - half, side * (cell / 16 + v) - half, height);
            points.push_back(support::probe(scene, floor, p, Vec3d::UnitZ(), 0));
        }
        for (const Estimate& e : support::irradiance(*method, points))
            irradiance.add(static_cast<double>(e.value.mean()));
        const double area = side * side;
        const double error = std::sqrt(std::pow(photons.standard_error[index], 2) +
                                       std::pow(irradiance.standard_error() * area, 2) +
                                       std::pow(1e-3 * mean_flux, 2));
        const double z = (irradiance.mean() * area - photons.mean[index]) / error;
        largest = std::max(largest, std::abs(z));
        if (dark) continue;
        squares += z * z;
        ++bright;
    }
    EXPECT_GT(bright, 60);
    EXPECT_LT(largest, support::sidak_bound(256));
    EXPECT_LT(squares / bright, 1 + 4 * std::sqrt(2.0 / bright));
}

TEST(BeamPhotons, AgreeInAPool) { expect_same_light(Scene(pool_mesh(96)), 1, 1); }
TEST(BeamPhotons, AgreeInARing) { expect_same_light(Scene(ring(48)), 1, 0.5); }
TEST(BeamPhotons, AgreeRoundABall) {
    SceneDesc desc;
    desc.shapes = {support::mesh("ball", tessellate_sphere(96),
                                 Transform(Eigen::Translation3d(0, 0, 0.6) * Eigen::Scaling(0.5)),
                                 support::mirror()),
                   support::horizontal("floor", 0, 4, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({1.5, 0.4, 1.6}, 5)};
    expect_same_light(Scene(desc), 1, 2);
}

}  // namespace
}  // namespace caustics

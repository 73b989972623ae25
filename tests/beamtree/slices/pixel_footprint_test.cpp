#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/render/pixel_cells.h"
#include "core/render/renderer.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

BeamTreeParams by_pixels(Intensity intensity = Intensity::area) {
    BeamTreeParams params;
    params.max_bounces = 1;
    params.pixel_footprint = true;
    params.intensity = intensity;
    return params;
}

/// What the pixels of a camera see of a horizontal floor, as if nothing else stood there.
struct SeenFloor {
    std::vector<ReceiverPoint> points;
    std::vector<PixelCell> cells;

    SeenFloor(const Scene& scene, std::size_t shape, double height, const Camera& camera) {
        for (int y = 0; y < camera.height; ++y)
            for (int x = 0; x < camera.width; ++x) {
                const Vec3d eye = camera.to_world.translation();
                const Vec3d ray = camera.towards(x + 0.5, y + 0.5);
                Vec3d at = eye + (height - eye.z()) / ray.z() * ray;
                at.z() = height;
                points.push_back(support::probe(scene, shape, at, Vec3d::UnitZ(), 0));
                const Eigen::AlignedBox2d film(Vec2d(x, y), Vec2d(x + 1, y + 1));
                cells.push_back(pixel_cell(camera, film, points.back()).value());
            }
        for (std::size_t i = 0; i < cells.size(); ++i) points[i].cell = &cells[i];
    }

    double area(std::size_t i) const {
        const auto& corners = cells[i].corners;
        return std::abs(cross(corners[2] - corners[0], corners[3] - corners[1])) / 2;
    }
    double flux(const Scene& scene, const BeamTreeParams& params) const {
        const auto found = support::irradiance(*build(scene, params, {}), points);
        double sum = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            sum += static_cast<double>(found[i].value.mean()) * area(i);
        return sum;
    }
};

// Pixels that tile the floor get all of the light, however obliquely they see it: but for how their own scale on the floor changes
// from one side of a pixel to the other.
TEST(PixelFootprint, GetsAllOfTheFlux) {
    SineHeightfield high = waves();
    for (SineWave& wave : high.waves) wave.amplitude *= 3;
    SceneDesc desc = pool_desc(1);
    desc.shapes[0] = support::mesh("water", tessellate_heightfield(high, 32), Transform::Identity(),
                                   support::glass(1.333F));
    const Scene scene(std::move(desc));
    double sent = 0;
    for (const BeamSet& set : trace_all_beams(scene, caster_meshes(scene, 2, PolygonKind::triangle),
                                              sample_lights(scene, 1, 1), {}))
        for (const Beam& beam : set.beams)
            sent += set.refracted ? static_cast<double>(beam.flux.mean()) : 0.0;
    const Camera camera = support::camera({0.5, -1.2, 4.5}, {0, 0, -1}, {0, 1, 0}, 42, 36, 36);
    const SeenFloor floor(scene, 1, -1, camera);
    EXPECT_NEAR(floor.flux(scene, by_pixels()) / sent, 1, 1e-4);
    EXPECT_NEAR(floor.flux(scene, by_pixels(Intensity::refined)) / sent, 1, 0.002);
}

// Of light that runs along the floor, too, whose beams are found on planes across the floor. Behind the mirror there is none;
// where a cell lies on both sides, a polygon's part is lit or not as its middle is.
TEST(PixelFootprint, IsTheMeanOfItsPoints) {
    const Scene scene(ring_desc(64));
    const Camera camera = support::camera({0.3, -2, 1.5}, {0, 0.1, 0}, {0, 0, 1}, 30, 24, 18);
    const SeenFloor floor(scene, 1, 0, camera);
    const auto means = support::irradiance(*build(scene, by_pixels(), {}), floor.points);
    BeamTreeParams at_points = by_pixels();
    at_points.pixel_footprint = false;
    const auto estimator = build(scene, at_points, {});
    Rng rng(11, Stage::test, 0);
    constexpr int count = 2000;
    int lit = 0;
    for (std::size_t i = 5; i < means.size(); i += 11) {
        const auto mean = static_cast<double>(means[i].value.mean());
        const PixelCell& cell = floor.cells[i];
        const double away = floor.points[i].position.head<2>().cast<double>().norm();
        if (std::abs(away - 0.5) < cell.radius) continue;
        std::vector<ReceiverPoint> points(count, floor.points[i]);
        for (ReceiverPoint& point : points) {
            // Nearly a parallelogram.
            const auto u = static_cast<double>(rng.next()), v = static_cast<double>(rng.next());
            point.cell = nullptr;
            point.position += ((1 - u) * ((1 - v) * cell.corner(0) + v * cell.corner(3)) +
                               u * ((1 - v) * cell.corner(1) + v * cell.corner(2)))
                                  .cast<float>();
        }
        double sum = 0, squares = 0;
        for (const Estimate& one : support::irradiance(*estimator, points)) {
            const auto value = static_cast<double>(one.value.mean());
            sum += value;
            squares += value * value;
        }
        const double expected = sum / count;
        const double error = std::sqrt((squares / count - expected * expected) / (count - 1));
        EXPECT_NEAR(mean, expected, 4 * error + 0.01 * expected) << i;
        lit += expected > 0 ? 1 : 0;
    }
    EXPECT_GE(lit, 9);
}

Film picture(SceneDesc desc, bool stratified, int samples, const RunOptions& how = {}) {
    desc.camera = support::camera({0.2, -0.4, 2}, {0, 0, 0}, {0, 1, 0}, 14, 24, 24);
    desc.sampling.stratified = stratified;
    const Scene scene(std::move(desc));
    RunOptions options = how;
    options.samples_per_pixel = samples;
    return render(scene, *build(scene, by_pixels(), options), options).film;
}

// A pixel is the mean of its samples' parts, as the film has them: but for the heights of the samples' points, at which
// caustic polygons are cut, where the trees' planes are not the receiver's.
TEST(PixelFootprint, IsTheSameWithAnyNumberOfSamples) {
    const Film one = picture(ring_desc(128), true, 1);
    for (const auto& [stratified, samples] : {std::pair{true, 9}, std::pair{false, 3}}) {
        const Film other = picture(ring_desc(128), stratified, samples);
        double sum = 0, all_apart = 0, each_apart = 0;
        int lit = 0;
        for (std::size_t i = 0; i < one.pixel_count(); ++i) {
            const float whole = one.rgb("caustic", i).mean();
            const float apart = other.rgb("caustic", i).mean() - whole;
            sum += static_cast<double>(whole);
            all_apart += static_cast<double>(apart);
            each_apart += static_cast<double>(std::abs(apart));
            lit += whole > 0 ? 1 : 0;
        }
        EXPECT_GT(lit, 300);
        EXPECT_LT(std::abs(all_apart), 1e-3 * sum);
        EXPECT_LT(each_apart, 1e-2 * sum);
    }
}

/// The sum of a picture's caustic.
double light_of(const Scene& scene, const BeamTreeParams& params, int samples) {
    RunOptions options;
    options.samples_per_pixel = samples;
    const Film film = render(scene, *build(scene, params, options), options).film;
    double sum = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        sum += static_cast<double>(film.rgb("caustic", i).mean());
    return sum;
}

// A floor's edge cuts pixels, and a ball shows its silhouette: light that is even over them is so in the picture, but for the share
// of a pixel's samples that see it.
TEST(PixelFootprint, KeepsEvenLightAtEdges) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", -3, 4, true, support::mirror()),
                   support::horizontal("floor", 0, 0.5, false, support::diffuse(0.5F)),
                   support::sphere("ball", {0.1, 0.9, 0.2}, 0.35, support::diffuse(0.5F))};
    desc.lights = {support::directional_light(Vec3d(0.6, 0, -0.8), 1)};
    desc.camera = support::camera({0.2, -0.3, -2}, {0, 0.1, 0}, {0, 1, 0}, 55, 20, 20);
    desc.sampling.stratified = true;
    const Scene scene(std::move(desc));
    const auto total = [&](bool by_pixel, int samples) {
        BeamTreeParams params = by_pixels();
        params.pixel_footprint = by_pixel;
        params.mesh_resolution = 64;
        return light_of(scene, params, samples);
    };
    const double points = total(false, 900);
    EXPECT_GT(points, 1);
    EXPECT_NEAR(total(true, 16) / points, 1, 0.01);
    EXPECT_NEAR(total(true, 100) / points, 1, 0.005);
}

TEST(PixelFootprint, HasTheSameBitsEverywhere) {
    RunOptions plain;
    plain.isa = Isa::plain;
    RunOptions wide;
    wide.isa = widest_isa();
    wide.threads = 3;
    const Film one = picture(ring_desc(48), true, 4, plain);
    const Film other = picture(ring_desc(48), true, 4, wide);
    for (std::size_t i = 0; i < one.pixel_count(); ++i)
        EXPECT_TRUE((one.rgb("caustic", i) == other.rgb("caustic", i)).all()) << i;
}

// The focus of a ball is much smaller than a pixel: four points of it get anything.
TEST(PixelFootprint, HoldsAFocus) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -1, 2, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, 0}, 0.4, support::glass(1.5F))};
    desc.lights = {support::directional_light(Vec3d(0.2, 0.1, -1).normalized(), 1)};
    desc.camera = support::camera({2.5, -2.5, 1}, {0.2, 0.1, -1}, {0, 0, 1}, 24, 24, 16);
    const auto flux = [&](bool by_pixel, int samples) {
        const Scene scene(desc);
        BeamTreeParams params = by_pixels();
        params.max_bounces = 2;
        params.mesh_resolution = 96;
        params.pixel_footprint = by_pixel;
        return light_of(scene, params, samples);
    };
    const double points = flux(false, 1600);
    EXPECT_NEAR(flux(true, 1) / points, 1, 0.02);
    EXPECT_NEAR(flux(true, 4) / points, 1, 0.02);
}

}  // namespace
}  // namespace caustics::beamtree

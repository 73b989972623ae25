#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_point.h"
#include "beamtree/beam_tracing.h"
#include "core/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

// A pool with folds over a floor, one mesh resolution after another. Means over pixels of the floor
// are exact: every caustic polygon is clipped to every pixel it touches.
constexpr int pixels = 64;
constexpr double floor_depth = 1;

SceneDesc pool(int resolution) {
    SineHeightfield field;
    field.waves = {{0.024, {7.1, 2.3}, 0.4}, {0.019, {-4.2, 8.6}, 1.9}, {0.011, {12.7, -6.1}, 3.1}};
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_heightfield(field, resolution),
                                 Transform::Identity(), support::glass(1.333F))};
    desc.point_lights = {support::point_light({0.4, 0.3, 2.5}, 10)};
    return desc;
}

BeamSet refracted_beams(int resolution) {
    const Scene scene(pool(resolution));
    const auto casters = caster_meshes(scene, 2);
    return trace_beams(scene, casters[0], sample_lights(scene, 1, 1)[0])[1];
}

using Polygon = std::vector<Vec2d>;

double area(const Polygon& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2d& a = p[i];
        const Vec2d& b = p[(i + 1) % p.size()];
        sum += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
    return std::abs(sum);
}

// The part of a polygon where side * (p[axis] - border) >= 0 [Sutherland and Hodgman 1974].
Polygon half(const Polygon& p, int axis, double border, double side) {
    Polygon kept;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2d& a = p[i];
        const Vec2d& b = p[(i + 1) % p.size()];
        const double da = side * (a[axis] - border);
        const double db = side * (b[axis] - border);
        if (da >= 0) kept.push_back(a);
        if ((da >= 0) != (db >= 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    return kept;
}

Polygon caustic_polygon(const std::array<const VertexRay*, 3>& rays) {
    Polygon polygon;
    for (const VertexRay* ray : rays) {
        const Vec3d p = ray->position.cast<double>();
        const Vec3d d = ray->direction.cast<double>();
        polygon.push_back((p + (p.z() + floor_depth) / -d.z() * d).head<2>());
    }
    return polygon;
}

int pixel(double x) { return static_cast<int>(std::floor((x + 1) / 2 * pixels)); }
double left_of(int index) { return 2.0 * index / pixels - 1; }

// Mean irradiance of each pixel of |x|, |y| <= 1.
std::vector<double> pixel_means(const BeamSet& set) {
    std::vector<double> flux(pixels * pixels);
    for (const Beam& beam : set.beams) {
        const Polygon polygon = caustic_polygon(set.triangle(beam, 0));
        const double whole = area(polygon);
        if (whole == 0) continue;
        Eigen::AlignedBox2d box;
        for (const Vec2d& p : polygon) box.extend(p);
        for (int i = std::max(0, pixel(box.min().x()));
             i <= std::min(pixels - 1, pixel(box.max().x())); ++i)
            for (int j = std::max(0, pixel(box.min().y()));
                 j <= std::min(pixels - 1, pixel(box.max().y())); ++j) {
                Polygon part = half(half(polygon, 0, left_of(i), 1), 0, left_of(i + 1), -1);
                part = half(half(part, 1, left_of(j), 1), 1, left_of(j + 1), -1);
                flux[static_cast<std::size_t>(j * pixels + i)] +=
                    static_cast<double>(beam.flux.mean()) * area(part) / whole;
            }
    }
    for (double& f : flux) f *= pixels * pixels / 4.0;
    return flux;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(BeamConvergence, PixelMeansAreOfSecondOrder) {
    const std::vector<double> truth = pixel_means(refracted_beams(1024));
    double last = 0;
    for (const int resolution : {64, 128, 256}) {
        const double error = rms_difference(pixel_means(refracted_beams(resolution)), truth);
        if (resolution > 64) {
            EXPECT_GT(std::log2(last / error), 1.8) << resolution;
        }
        last = error;
    }
}

// Eq. 11 conserves flux: the irradiance that the beam-point test tells, times the area of the caustic
// polygon found on its own, adds up to what goes through a much finer water surface.
TEST(BeamConvergence, FluxThroughTheFloorIsThatThroughTheWater) {
    double through_water = 0;
    for (const Beam& beam : refracted_beams(512).beams)
        through_water += static_cast<double>(beam.flux.mean());
    const BeamSet set = refracted_beams(32);
    double through_floor = 0;
    std::array<BeamHit, 2> hits;
    for (const Beam& beam : set.beams) {
        const Polygon polygon = caustic_polygon(set.triangle(beam, 0));
        const Vec2d middle = (polygon[0] + polygon[1] + polygon[2]) / 3;
        const Vec3 point = Vec3d(middle.x(), middle.y(), -floor_depth).cast<float>();
        const int count = test_beam(set, beam, TestPlane(point, Vec3::UnitZ()), hits);
        if (count == 0) continue;  // thinner than the rounding of its middle
        EXPECT_EQ(count, 1);
        through_floor += static_cast<double>(beam.flux.mean()) / hits[0].area * area(polygon);
    }
    EXPECT_NEAR(through_floor / through_water, 1, 1e-4);
}

}  // namespace
}  // namespace caustics

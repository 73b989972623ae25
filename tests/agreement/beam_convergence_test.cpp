#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "beamtree/beam_tree.h"
#include "beamtree/tracing/beam_tracing.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/sanitizers.h"

namespace caustics {
namespace {

// A pool over a floor so deep that caustics fold. The truth is the light that rays bring through the exact
// water; the beams' picture of a mesh is taken in two steps: what `beamtree` answers at a point is the sum of
// flux / area over the caustic polygons that hold it, found here on their own, and so its means over
// pixels are those of the polygons. Pixels have a smooth filter, four of them wide, for which sums
// over rays and over points of polygons converge fast.
constexpr int pixels = 32;
constexpr double floor_depth = 3;
constexpr double floor_half = 3.2;
constexpr double ior = 1.333;
const Vec3d light(0.4, 0.3, 2.5);
constexpr double folded_lamp = 10;

SineHeightfield water() {
    SineHeightfield field;
    field.waves = {{0.024, {7.1, 2.3}, 0.4}, {0.019, {-4.2, 8.6}, 1.9}, {0.011, {12.7, -6.1}, 3.1}};
    return field;
}

SceneDesc pool(int resolution) {
    SceneDesc desc;
    desc.shapes = {
        support::mesh("water", tessellate_heightfield(water(), resolution), Transform::Identity(),
                      support::glass(static_cast<float>(ior))),
        support::horizontal("floor", -floor_depth, floor_half, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light(light, static_cast<float>(folded_lamp))};
    return desc;
}

/// One wave along a row of points: its sine is that of the point before, turned by one step.
struct WaveAlongRow {
    const SineWave& wave;
    std::complex<double> at, step;

    WaveAlongRow(const SineWave& sine, const Vec2d& start, double distance)
        : wave(sine),
          at(std::polar(1.0, sine.wave_vector.dot(start) + sine.phase)),
          step(std::polar(1.0, sine.wave_vector.x() * distance)) {}
};

/// A ray from the light, bent at the exact water: where it comes down, and its flux per m^2 of the
/// undisturbed surface.
struct BentRay {
    Vec2d at;
    double flux;
};

BentRay bend(const Vec2d& xy, double height, const Vec2d& slope) {
    const Vec3d p(xy.x(), xy.y(), height);
    const Vec3d across(-slope.x(), -slope.y(), 1);  // the normal, times the area over 1 m^2
    const double area = across.norm();
    const Vec3d normal = across / area;
    const double distance = (light - p).norm();
    const Vec3d w = (light - p) / distance;
    const double cosine = w.dot(normal);
    const double inner = support::refracted_cosine(cosine, ior);
    const Vec3d down = (cosine * normal - w) / ior - inner * normal;
    const double way = (p.z() + floor_depth) / -down.z();
    return {xy + way * down.head<2>(), folded_lamp * cosine * area / (distance * distance) *
                                           (1 - support::fresnel(cosine, ior))};
}

/// Mean irradiance of the pixels of the floor's |x|, |y| <= 1.
class PixelMeans {
public:
    void add(const Vec2d& at, double flux) {
        const Vec2d place = (at + Vec2d::Ones()) * pixels / 2;
        const auto first = [](double x) { return static_cast<int>(std::ceil(x - 2.5)); };
        for (int j = first(place.y()); j < first(place.y()) + 4; ++j)
            for (int i = first(place.x()); i < first(place.x()) + 4; ++i)
                if (std::min(i, j) >= 0 && std::max(i, j) < pixels)
                    means_[static_cast<std::size_t>(j * pixels + i)] +=
                        flux * filter(place.x() - i - 0.5) * filter(place.y() - j - 0.5);
    }
    double rms_difference(const PixelMeans& other) const {
        double sum = 0;
        for (std::size_t i = 0; i < means_.size(); ++i)
            sum += std::pow(means_[i] - other.means_[i], 2);
        return std::sqrt(sum / static_cast<double>(means_.size()));
    }

private:
    // Per metre; within two pixels.
    static double filter(double x) { return (1 + std::cos(pi_d * x / 2)) / 4 * pixels / 2; }

    std::vector<double> means_ = std::vector<double>(pixels * pixels);
};

/// Flux through the water by rays on a lattice of side x side.
struct ForwardLight {
    double flux = 0;
    double farthest = 0;  ///< |x| or |y| on the floor
    PixelMeans pixel_means;
};

ForwardLight forward_light(int side) {
    const SineHeightfield field = water();
    ForwardLight found;
    const double step = 2.0 / side;
    for (int row = 0; row < side; ++row) {
        Vec2d xy(-1 + step / 2, -1 + (row + 0.5) * step);
        std::vector<WaveAlongRow> waves;
        for (const SineWave& wave : field.waves) waves.emplace_back(wave, xy, step);
        for (int column = 0; column < side; ++column, xy.x() += step) {
            double height = 0;
            Vec2d slope = Vec2d::Zero();
            for (WaveAlongRow& w : waves) {
                height += w.wave.amplitude * w.at.imag();
                slope += w.wave.amplitude * w.at.real() * w.wave.wave_vector;
                w.at = {w.at.real() * w.step.real() - w.at.imag() * w.step.imag(),
                        w.at.real() * w.step.imag() + w.at.imag() * w.step.real()};
            }
            const BentRay ray = bend(xy, height, slope);
            const double flux = ray.flux * step * step;
            found.flux += flux;
            found.farthest = std::max(found.farthest, ray.at.cwiseAbs().maxCoeff());
            found.pixel_means.add(ray.at, flux);
        }
    }
    return found;
}

beamtree::BeamSet refracted_beams(int resolution) {
    const Scene scene(pool(resolution));
    const auto casters = beamtree::caster_meshes(scene, 2);
    return beamtree::trace_beams(scene, casters[0], beamtree::sample_lights(scene, 1, 1)[0])[1];
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

Polygon caustic_polygon(const std::array<const beamtree::VertexRay*, 3>& rays) {
    Polygon polygon;
    for (const beamtree::VertexRay* ray : rays) {
        const Vec3d p = ray->position.cast<double>();
        const Vec3d d = ray->direction.cast<double>();
        polygon.push_back((p + (p.z() + floor_depth) / -d.z() * d).head<2>());
    }
    return polygon;
}

PixelMeans pixel_means(const beamtree::BeamSet& set) {
    constexpr int parts = 6;
    PixelMeans means;
    for (const beamtree::Beam& beam : set.beams) {
        const Polygon p = caustic_polygon(set.triangle(beam, 0));
        const double flux = static_cast<double>(beam.flux.mean()) / (parts * parts);
        const auto add = [&](double u, double v) {
            means.add(p[0] + (u * (p[1] - p[0]) + v * (p[2] - p[0])) / parts, flux);
        };
        for (int i = 0; i < parts; ++i)
            for (int j = 0; i + j < parts; ++j) {
                add(i + 1.0 / 3, j + 1.0 / 3);
                if (i + j + 2 <= parts) add(i + 2.0 / 3, j + 2.0 / 3);
            }
    }
    return means;
}

// By the winding round it.
bool holds(const Polygon& p, const Vec2d& at) {
    int positive = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d a = p[i] - at;
        const Vec2d b = p[(i + 1) % 3] - at;
        positive += a.x() * b.y() - a.y() * b.x() > 0;
    }
    return positive == 0 || positive == 3;
}

// In the middle of each and anywhere: so the irradiance all over the floor adds up to their flux.
TEST(BeamConvergence, ThePolygonsThatHoldAPointLightIt) {
    const beamtree::BeamSet set = refracted_beams(24);
    std::vector<Polygon> polygons;
    for (const beamtree::Beam& beam : set.beams)
        polygons.push_back(caustic_polygon(set.triangle(beam, 0)));
    const Scene scene(pool(24));
    std::vector<ReceiverPoint> points;
    std::vector<double> truth;
    Rng rng(2, Stage::test, 0);
    int folded = 0;
    for (std::size_t i = 0; i < 2 * polygons.size(); ++i) {
        const Vec2 random(2.4F * rng.next() - 1.2F, 2.4F * rng.next() - 1.2F);
        const Polygon& p = polygons[i / 2];
        const Vec2 middle = Vec2d((p[0] + p[1] + p[2]) / 3).cast<float>();
        const Vec2d at = (i % 2 == 0 ? middle : random).cast<double>();
        points.push_back(
            support::probe(scene, 1, {at.x(), at.y(), -floor_depth}, Vec3d::UnitZ(), 0));
        truth.push_back(0);
        int held = 0;
        for (std::size_t k = 0; k < polygons.size(); ++k)
            if (holds(polygons[k], at)) {
                truth.back() += static_cast<double>(set.beams[k].flux.mean()) / area(polygons[k]);
                ++held;
            }
        folded += held > 1;
    }
    const auto found =
        support::irradiance(*build(scene, beamtree::BeamTreeParams::chuang1995(), {}), points);
    int on_a_rim = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        on_a_rim += std::abs(static_cast<double>(found[i].value.mean()) - truth[i]) >
                    1e-4 * truth[i] + 1e-6;
    }
    EXPECT_GT(folded, 30);
    EXPECT_LE(on_a_rim, 3);
}

TEST(BeamConvergence, PixelMeansAreOfSecondOrder) {
    const PixelMeans truth = forward_light(768).pixel_means;
    EXPECT_LT(truth.rms_difference(forward_light(500).pixel_means), 1e-5);
    double last = 0;
    for (const int resolution : {32, 64, 128}) {
        const double error = truth.rms_difference(pixel_means(refracted_beams(resolution)));
        if (resolution > 32) {
            EXPECT_GT(std::log2(last / error), 1.8) << resolution << ", " << error;
        }
        last = error;
    }
}

// Eq. 11 conserves flux: what the caustic polygons hold is what rays bring through the exact water.
TEST(BeamConvergence, FluxThroughTheFloorIsThatThroughTheWater) {
    const ForwardLight truth = forward_light(512);
    ASSERT_LT(truth.farthest, floor_half);
    double through_polygons = 0;
    for (const beamtree::Beam& beam : refracted_beams(32).beams)
        through_polygons += static_cast<double>(beam.flux.mean());
    EXPECT_NEAR(through_polygons / truth.flux, 1, 1e-4);
}

}  // namespace
}  // namespace caustics

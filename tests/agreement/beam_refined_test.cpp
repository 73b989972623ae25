#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "beamtree/beam_tracing.h"
#include "beamtree/beam_tree.h"
#include "beamtree/refined_density.h"
#include "core/rng.h"
#include "core/tessellate.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics {
namespace {

// A pool deep enough for caustics to fold. The truth at a point of the floor is the light along every ray
// through the exact water that comes there: each root of the map from the surface to the floor brings
// its flux over the map's determinant.
constexpr double floor_depth = 3;
constexpr double ior = 1.333;

SineHeightfield water() {
    SineHeightfield field;
    field.waves = {{0.024, {7.1, 2.3}, 0.4}, {0.019, {-4.2, 8.6}, 1.9}, {0.011, {12.7, -6.1}, 3.1}};
    return field;
}

enum class Lamp { point, directional, area };

SceneDesc pool(TriangleMesh surface, Lamp lamp) {
    SceneDesc desc;
    desc.shapes = {support::mesh("water", std::move(surface), Transform::Identity(),
                                 support::glass(static_cast<float>(ior))),
                   support::horizontal("floor", -floor_depth, 3.2, true, support::diffuse(0.5F))};
    if (lamp == Lamp::point) desc.point_lights = {support::point_light({0.4, 0.3, 2.5}, 10)};
    if (lamp == Lamp::directional)
        desc.directional_lights = {support::directional_light({0.3, -0.2, -1}, 2)};
    if (lamp == Lamp::area) {
        desc.shapes.push_back(support::horizontal("lamp", 2.5, 0.3, false, support::diffuse(0)));
        desc.shapes.back().radiance = Spectrum(Spectrum::Constant(20));
    }
    return desc;
}

/// The floor under the exact water, lit by some light samples.
class ExactPool {
public:
    explicit ExactPool(std::vector<LightSample> lights) : lights_(std::move(lights)) {
        for (const LightSample& light : lights_) sort_cells(light);
    }

    /// Irradiance [W m^-2]; none where a ray from near the rim of the water comes, where meshes know
    /// derivatives from one side only.
    std::optional<double> irradiance(const Vec2d& at) const {
        double sum = 0;
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            const auto found = irradiance(i, at);
            if (!found) return {};
            sum += *found;
        }
        return sum;
    }

private:
    static constexpr int side = 256;
    static constexpr int bins = 160;
    static constexpr double half_floor = 2;

    struct Bent {
        Vec2d at;
        double flux;  ///< for an area of the undisturbed surface
    };

    Bent bend(const LightSample& light, const Vec2d& xy) const {
        const Vec2d slope = field_.gradient(xy);
        const Vec3d p(xy.x(), xy.y(), field_.height(xy));
        const Vec3d across(-slope.x(), -slope.y(), 1);
        const double area = across.norm();
        const Vec3d normal = across / area;
        Vec3d w = -light.travel.cast<double>();
        double strength = static_cast<double>(light.strength.mean());
        if (light.kind != LightSample::Kind::directional) {
            const Vec3d away = light.position.cast<double>() - p;
            w = away.normalized();
            strength /= away.squaredNorm();
        }
        if (light.kind == LightSample::Kind::area) strength *= -light.normal.cast<double>().dot(w);
        const double cosine = w.dot(normal);
        const double inner = support::refracted_cosine(cosine, ior);
        const Vec3d down = (cosine * normal - w) / ior - inner * normal;
        const double way = (p.z() + floor_depth) / -down.z();
        return {xy + way * down.head<2>(),
                strength * cosine * area * (1 - support::fresnel(cosine, ior))};
    }

    Eigen::Matrix2d jacobian(const LightSample& light, const Vec2d& xy) const {
        constexpr double step = 1e-5;
        Eigen::Matrix2d found;
        for (int i = 0; i < 2; ++i)
            found.col(i) = (bend(light, xy + step * Vec2d::Unit(i)).at -
                            bend(light, xy - step * Vec2d::Unit(i)).at) /
                           (2 * step);
        return found;
    }

    // Half cells of a grid on the water by the places of the floor that they light.
    void sort_cells(const LightSample& light) {
        std::vector<Vec2d> at;
        for (int j = 0; j <= side; ++j)
            for (int i = 0; i <= side; ++i) at.push_back(bend(light, corner(i, j)).at);
        std::vector<std::vector<Half>> sorted(bins * bins);
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
                for (const bool upper : {false, true}) add({i, j, upper}, at, sorted);
        images_.push_back(std::move(at));
        sorted_.push_back(std::move(sorted));
    }

    struct Half {
        int i, j;
        bool upper;
    };

    static Vec2d corner(int i, int j) { return Vec2d(2.0 * i / side - 1, 2.0 * j / side - 1); }
    static std::array<std::size_t, 3> corners(const Half& half) {
        const auto index = [](int i, int j) {
            return static_cast<std::size_t>(j) * (side + 1) + static_cast<std::size_t>(i);
        };
        const auto& [i, j, upper] = half;
        return {index(i, j), upper ? index(i + 1, j + 1) : index(i + 1, j),
                upper ? index(i, j + 1) : index(i + 1, j + 1)};
    }
    static int bin(double x) {
        return std::clamp(static_cast<int>((x / half_floor + 1) * bins / 2), 0, bins - 1);
    }

    static void add(const Half& half, const std::vector<Vec2d>& at,
                    std::vector<std::vector<Half>>& sorted) {
        Eigen::AlignedBox2d box;
        for (const std::size_t c : corners(half)) box.extend(at[c]);
        for (int y = bin(box.min().y()); y <= bin(box.max().y()); ++y)
            for (int x = bin(box.min().x()); x <= bin(box.max().x()); ++x)
                sorted[static_cast<std::size_t>(y * bins + x)].push_back(half);
    }

    std::optional<double> irradiance(std::size_t light, const Vec2d& at) const {
        std::vector<Vec2d> roots;
        double sum = 0;
        const auto place = static_cast<std::size_t>(bin(at.y()) * bins + bin(at.x()));
        for (const Half& half : sorted_[light][place]) {
            if (!holds(light, half, at)) continue;
            const Vec2d root = newton(light, corner(half.i, half.j), at);
            const bool known = std::any_of(roots.begin(), roots.end(), [&](const Vec2d& r) {
                return (r - root).norm() < 1e-7;
            });
            if (known) continue;
            roots.push_back(root);
            if (root.cwiseAbs().maxCoeff() > 0.9) return {};
            sum += bend(lights_[light], root).flux /
                   std::abs(jacobian(lights_[light], root).determinant());
        }
        return sum;
    }

    bool holds(std::size_t light, const Half& half, const Vec2d& at) const {
        const auto c = corners(half);
        int positive = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2d a = images_[light][c[k]] - at;
            const Vec2d b = images_[light][c[(k + 1) % 3]] - at;
            positive += a.x() * b.y() - a.y() * b.x() > 0;
        }
        return positive == 0 || positive == 3;
    }

    Vec2d newton(std::size_t light, Vec2d xy, const Vec2d& at) const {
        for (int step = 0; step < 12; ++step)
            xy -= jacobian(lights_[light], xy).inverse() * (bend(lights_[light], xy).at - at);
        return xy;
    }

    SineHeightfield field_ = water();
    std::vector<LightSample> lights_;
    std::vector<std::vector<Vec2d>> images_;              ///< one a light
    std::vector<std::vector<std::vector<Half>>> sorted_;  ///< one a light
};

struct Errors {
    double median = 0;
    double mean = 0;  ///< of the smaller of the relative error and 1
};

/// Points of the floor with their true irradiance.
class PointwiseTruth {
public:
    explicit PointwiseTruth(Lamp lamp, int light_samples = 1) : lamp_(lamp) {
        const Scene scene(pool(tessellate_heightfield(water(), 4), lamp));
        const ExactPool exact(sample_lights(scene, light_samples, 1));
        Rng rng(6, Stage::test, 0);
        while (points_.size() < 1000) {
            const Vec2d at(1.6F * rng.next() - 0.8F, 1.6F * rng.next() - 0.8F);
            const auto irradiance = exact.irradiance(at.cast<float>().cast<double>());
            if (!irradiance || *irradiance == 0) continue;
            points_.push_back(at);
            irradiance_.push_back(*irradiance);
        }
    }

    Errors errors(TriangleMesh surface, const BeamTreeParams& params) const {
        const Scene scene(pool(std::move(surface), lamp_));
        std::vector<ReceiverPoint> probes;
        for (const Vec2d& at : points_)
            probes.push_back(
                support::probe(scene, 1, {at.x(), at.y(), -floor_depth}, Vec3d::UnitZ(), 0));
        const auto found = support::irradiance(*build(scene, params, {}), probes);
        Errors errors;
        std::vector<double> all;
        for (std::size_t i = 0; i < found.size(); ++i) {
            all.push_back(
                std::abs(static_cast<double>(found[i].value.mean()) / irradiance_[i] - 1));
            errors.mean += std::min(all.back(), 1.0) / static_cast<double>(found.size());
        }
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                         all.end());
        errors.median = all[all.size() / 2];
        return errors;
    }

private:
    Lamp lamp_;
    std::vector<Vec2d> points_;
    std::vector<double> irradiance_;
};

BeamTreeParams with(Intensity intensity) {
    BeamTreeParams params;
    params.bound = Bound::sphere_swept;
    params.intensity = intensity;
    params.light_samples = 1;
    return params;
}

BeamTreeParams refined(PolygonKind polygons = PolygonKind::triangle,
                       BeamTreeParams::Leaf leaf = BeamTreeParams::Leaf::n) {
    BeamTreeParams params = with(Intensity::refined);
    params.polygons = polygons;
    params.leaf = leaf;
    return params;
}

// Vertices of the same water moved about by up to 0.3 of a cell, without a regular subdivision.
TriangleMesh irregular(int n) {
    TriangleMesh mesh = tessellate_heightfield(water(), n);
    mesh.patches.clear();
    Rng rng(8, Stage::test, 0);
    const SineHeightfield field = water();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        Vec2d at = mesh.positions[i].head<2>().cast<double>();
        const Vec2 move =
            0.6F / static_cast<float>(n) * Vec2(2 * rng.next() - 1, 2 * rng.next() - 1);
        if (at.cwiseAbs().maxCoeff() < 0.999) at += move.cast<double>();
        mesh.positions[i] = Vec3d(at.x(), at.y(), field.height(at)).cast<float>();
        mesh.normals[i] = field.normal(at).cast<float>();
    }
    return mesh;
}

double order(const Errors& coarse, const Errors& fine) {
    return std::log2(coarse.median / fine.median);
}

TEST(BeamRefined, IsOfSecondOrderAtPoints) {
    const PointwiseTruth truth(Lamp::point);
    const auto water_of = [](int n) { return tessellate_heightfield(water(), n); };
    for (const BeamTreeParams& params :
         {refined(), refined(PolygonKind::quad, BeamTreeParams::Leaf::k)}) {
        const Errors coarse = truth.errors(water_of(48), params);
        const Errors fine = truth.errors(water_of(96), params);
        EXPECT_GT(order(coarse, fine), 1.9) << coarse.median << ", " << fine.median;
        EXPECT_LT(fine.median, 0.003);
        EXPECT_LT(fine.mean, 0.008);
    }
    // The paper's eq. 11, as a control: first order.
    const Errors coarse = truth.errors(water_of(48), with(Intensity::area));
    const Errors fine = truth.errors(water_of(96), with(Intensity::area));
    EXPECT_NEAR(order(coarse, fine), 1, 0.15);
    EXPECT_GT(fine.median, 0.015);
}

TEST(BeamRefined, IsSoUnderEveryKindOfLight) {
    for (const Lamp lamp : {Lamp::directional, Lamp::area}) {
        const PointwiseTruth truth(lamp);
        const Errors coarse = truth.errors(tessellate_heightfield(water(), 48), refined());
        const Errors fine = truth.errors(tessellate_heightfield(water(), 96), refined());
        EXPECT_GT(order(coarse, fine), 1.9) << coarse.median << ", " << fine.median;
    }
}

// The two triangles of a pair are no parallelogram any more, and a first order is left: a tenth of eq. 11's.
TEST(BeamRefined, GainsOnIrregularMeshesToo) {
    const PointwiseTruth truth(Lamp::point);
    const Errors coarse = truth.errors(irregular(48), refined());
    const Errors fine = truth.errors(irregular(96), refined());
    EXPECT_GT(order(coarse, fine), 1.5) << coarse.median << ", " << fine.median;
    EXPECT_LT(fine.median, truth.errors(irregular(96), with(Intensity::area)).median / 5);
}

/// Flux on a horizontal plane, added up over small parts of the caustic polygons, over that of the beams.
double flux_on_plane(const BeamSet& set, float z) {
    constexpr int parts = 6;
    double found = 0;
    double sent = 0;
    SearchCounts counts;
    const auto add = [&](std::uint32_t number, std::size_t which, const std::array<Vec3d, 3>& at,
                         double u, double v) {
        const Vec3 point =
            Vec3d(at[0] + (u * (at[1] - at[0]) + v * (at[2] - at[0])) / parts).cast<float>();
        const double area = (at[1] - at[0]).cross(at[2] - at[0]).norm() / (2 * parts * parts);
        std::vector<BeamHit> hits;
        find_in_beam(set, {0, number}, TestPlane(point, Vec3::UnitZ()), hits, counts);
        for (const BeamHit& hit : hits)
            if (hit.triangle == which)
                found += static_cast<double>(set.beams[number].flux.mean()) * area *
                         refined_density(set, hit, point).value_or(hit.flux_share / hit.area);
    };
    for (std::uint32_t number = 0; number < set.beams.size(); ++number) {
        const Beam& beam = set.beams[number];
        sent += static_cast<double>(beam.flux.mean());
        for (std::size_t which = 0; which < beam.triangle_count(); ++which) {
            std::array<Vec3d, 3> at;
            for (std::size_t i = 0; i < 3; ++i) {
                const VertexRay& ray = *set.triangle(beam, which)[i];
                at[i] = (ray.position + (z - ray.position.z()) / ray.direction.z() * ray.direction)
                            .cast<double>();
            }
            for (int i = 0; i < parts; ++i)
                for (int j = 0; i + j < parts; ++j) {
                    add(number, which, at, i + 1.0 / 3, j + 1.0 / 3);
                    if (i + j + 2 <= parts) add(number, which, at, i + 2.0 / 3, j + 2.0 / 3);
                }
        }
    }
    return found / sent;
}

TEST(BeamRefined, KeepsTheFlux) {
    for (const PolygonKind kind : {PolygonKind::triangle, PolygonKind::quad})
        for (const TriangleMesh& mesh : {tessellate_heightfield(water(), 48), irregular(48)}) {
            const Scene scene(pool(mesh, Lamp::point));
            const auto sets = trace_all_beams(scene, caster_meshes(scene, 2, kind),
                                              sample_lights(scene, 1, 1), {Intensity::refined}, {})
                                  .sets;
            for (const BeamSet& set : sets)
                if (set.refracted) {
                    EXPECT_NEAR(flux_on_plane(set, -1), 1, 1e-3);
                    EXPECT_NEAR(flux_on_plane(set, -floor_depth), 1, 1e-3);
                }
        }
}

// A lamp under still water: its window is cut out of the triangles, and what is cut keeps to eq. 11.
TEST(BeamRefined, TakesCutPolygons) {
    SceneDesc desc;
    const Transform size(Eigen::Scaling(3.0, 3.0, 1.0));
    desc.shapes = {support::mesh("water", tessellate_rectangle(32), size, support::glass(1.333F))};
    desc.point_lights = {support::point_light({0.02, 0.03, -1}, 1)};
    const Scene scene(std::move(desc));
    const auto sets = trace_all_beams(scene, caster_meshes(scene, 2), sample_lights(scene, 1, 1),
                                      {Intensity::refined}, {})
                          .sets;
    ASSERT_EQ(sets.size(), 2U);
    const BeamSet& reflected = sets[0];
    EXPECT_NEAR(flux_on_plane(reflected, -2), 1, 2e-3);
}

/// The table of results/beamtree/README.md.
TEST(BeamRefined, DISABLED_TableOfErrors) {
    const PointwiseTruth truth(Lamp::point);
    std::printf(
        "| n | area: median | mean | refined: median | mean | irregular, area: median | mean "
        "| irregular, refined: median | mean |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const int n : {32, 64, 128, 256}) {
        std::printf("| %d |", n);
        for (const TriangleMesh& mesh : {tessellate_heightfield(water(), n), irregular(n)})
            for (const Intensity intensity : {Intensity::area, Intensity::refined}) {
                const Errors e = truth.errors(mesh, with(intensity));
                std::printf(" %.5f | %.5f |", e.median, e.mean);
            }
        std::printf("\n");
    }
}

}  // namespace
}  // namespace caustics

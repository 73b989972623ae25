#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "beamtree/beam_tree.h"
#include "beamtree/light/find_in_beam.h"
#include "beamtree/light/refined_density.h"
#include "beamtree/tracing/beam_tracing.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/agreement/exact_pool.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

using namespace exact_pool;

// Over squares much smaller than a polygon: points of their own are asked for roots, which go by the mesh's normals and
// not by the smooth water's.
beamtree::BeamTreeParams refined(beamtree::PolygonKind polygons = beamtree::PolygonKind::triangle) {
    beamtree::BeamTreeParams params = with(beamtree::Intensity::refined);
    params.polygons = polygons;
    params.bound = beamtree::Bound::two_slice;
    params.leaf = beamtree::BeamTreeParams::Leaf::fixed;
    params.footprint = 2e-4F;
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
    const auto water_of = [](int n) { return meshed(tessellate_heightfield(water(), n)); };
    for (const beamtree::BeamTreeParams& params :
         {refined(), refined(beamtree::PolygonKind::quad)}) {
        const Errors coarse = truth.errors(water_of(48), params);
        const Errors fine = truth.errors(water_of(96), params);
        EXPECT_GT(order(coarse, fine), 1.9) << coarse.median << ", " << fine.median;
        EXPECT_LT(fine.median, 0.003);
        EXPECT_LT(fine.mean, 0.008);
    }
    // [CC95 (11)], as a control: first order.
    const Errors coarse = truth.errors(water_of(48), with(beamtree::Intensity::area));
    const Errors fine = truth.errors(water_of(96), with(beamtree::Intensity::area));
    EXPECT_NEAR(order(coarse, fine), 1, 0.15);
    EXPECT_GT(fine.median, 0.015);
}

TEST(BeamRefined, IsSoUnderEveryKindOfLight) {
    for (const Lamp lamp : {Lamp::directional, Lamp::area}) {
        const PointwiseTruth truth(lamp);
        const Errors coarse = truth.errors(meshed(tessellate_heightfield(water(), 48)), refined());
        const Errors fine = truth.errors(meshed(tessellate_heightfield(water(), 96)), refined());
        EXPECT_GT(order(coarse, fine), 1.9) << coarse.median << ", " << fine.median;
    }
}

// The two triangles of a pair are no parallelogram any more, and a first order is left: a tenth of eq. 11's.
TEST(BeamRefined, GainsOnIrregularMeshesToo) {
    const PointwiseTruth truth(Lamp::point);
    const Errors coarse = truth.errors(meshed(irregular(48)), refined());
    const Errors fine = truth.errors(meshed(irregular(96)), refined());
    EXPECT_GT(order(coarse, fine), 1.5) << coarse.median << ", " << fine.median;
    EXPECT_LT(fine.median,
              truth.errors(meshed(irregular(96)), with(beamtree::Intensity::area)).median / 5);
}

/// Flux on a horizontal plane, added up over small parts of the caustic polygons, over that of the beams.
double flux_on_plane(const beamtree::BeamSet& set, float z) {
    constexpr int parts = 6;
    double found = 0;
    double sent = 0;
    beamtree::SearchCounts counts;
    const auto add = [&](std::uint32_t number, std::size_t which, const std::array<Vec3d, 3>& at,
                         double u, double v) {
        const Vec3 point =
            Vec3d(at[0] + (u * (at[1] - at[0]) + v * (at[2] - at[0])) / parts).cast<float>();
        const double area = (at[1] - at[0]).cross(at[2] - at[0]).norm() / (2 * parts * parts);
        std::vector<beamtree::BeamHit> hits;
        beamtree::find_in_beam(set, {0, number}, beamtree::TestPlane(point, Vec3::UnitZ()), hits,
                               counts);
        for (const beamtree::BeamHit& hit : hits)
            if (hit.triangle == which)
                found +=
                    static_cast<double>(set.beams[number].flux.mean()) * area *
                    beamtree::refined_density(set, hit, point).value_or(hit.flux_share / hit.area);
    };
    for (std::uint32_t number = 0; number < set.beams.size(); ++number) {
        const beamtree::Beam& beam = set.beams[number];
        sent += static_cast<double>(beam.flux.mean());
        for (std::size_t which = 0; which < beam.triangle_count(); ++which) {
            std::array<Vec3d, 3> at;
            for (std::size_t i = 0; i < 3; ++i) {
                const beamtree::VertexRay& ray = *set.triangle(beam, which)[i];
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
    for (const beamtree::PolygonKind kind :
         {beamtree::PolygonKind::triangle, beamtree::PolygonKind::quad})
        for (const TriangleMesh& mesh : {tessellate_heightfield(water(), 48), irregular(48)}) {
            const Scene scene(pool(meshed(mesh), Lamp::point));
            const auto sets =
                beamtree::trace_all_beams(scene, beamtree::caster_meshes(scene, 2, kind),
                                          beamtree::sample_lights(scene, 1, 1),
                                          {beamtree::Intensity::refined}, {})
                    .sets;
            for (const beamtree::BeamSet& set : sets)
                if (set.refracted) {
                    EXPECT_NEAR(flux_on_plane(set, -1), 1, 1e-3);
                    EXPECT_NEAR(flux_on_plane(set, -floor_depth), 1, 1e-3);
                }
        }
}

// A lamp under still water: its window is cut out of the triangles.
TEST(BeamRefined, TakesCutPolygons) {
    SceneDesc desc;
    const Transform size(Eigen::Scaling(3.0, 3.0, 1.0));
    desc.shapes = {support::mesh("water", tessellate_rectangle(32), size, support::glass(1.333F))};
    desc.lights = {support::point_light({0.02, 0.03, -1}, 1)};
    const Scene scene(std::move(desc));
    const auto sets = beamtree::trace_all_beams(scene, beamtree::caster_meshes(scene, 2),
                                                beamtree::sample_lights(scene, 1, 1),
                                                {beamtree::Intensity::refined}, {})
                          .sets;
    ASSERT_EQ(sets.size(), 2U);
    const beamtree::BeamSet& reflected = sets[0];
    EXPECT_NEAR(flux_on_plane(reflected, -2), 1, 2e-3);
}

// A point light of 1 W/sr or a spot of that at height H above a pane of thickness T, which the floor lies D below: what
// goes straight through at the angle a, b in glass, lands at r = (H + D) tan a + T tan b, and so
// E = (1 - R)^2 f(a) sin a / (r dr/da).
constexpr double pane_height = 1.25;
constexpr double pane_thickness = 0.3;
constexpr double below_pane = 0.45;
constexpr double spot_edge = pi_d / 3;
constexpr double spot_middle = pi_d / 36;

double radius_below_pane(double angle) {
    return (pane_height + below_pane) * std::tan(angle) +
           pane_thickness * std::tan(std::asin(std::sin(angle) / 1.5));
}

double irradiance_below_pane(double angle, bool spot) {
    const double slope = (radius_below_pane(angle + 1e-6) - radius_below_pane(angle - 1e-6)) / 2e-6;
    const double through = 1 - support::fresnel(std::cos(angle), 1.5);
    const double falloff =
        spot ? std::clamp((spot_edge - angle) / (spot_edge - spot_middle), 0.0, 1.0) : 1;
    return through * through * falloff * std::sin(angle) / (radius_below_pane(angle) * slope);
}

/// The largest error, of the true irradiance.
double error_below_pane(bool spot, beamtree::Intensity intensity) {
    SceneDesc desc;
    const Transform place(Eigen::Translation3d(0, 0, below_pane + pane_thickness / 2) *
                          Eigen::Scaling(4.0, 4.0, pane_thickness / 2));
    desc.shapes = {support::mesh("pane", tessellate_cube(1), place, support::glass(1.5F)),
                   support::horizontal("floor", 0, 2, true, support::diffuse(0.5F))};
    const Vec3d lamp(0.3, -0.2, below_pane + pane_thickness + pane_height);
    if (spot)
        desc.lights = {SpotLight{
            lamp.cast<float>(),
            Spectrum::Ones(),
            {-Vec3::UnitZ(), static_cast<float>(spot_middle), static_cast<float>(spot_edge)}}};
    else
        desc.lights = {support::point_light(lamp, 1)};
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    std::vector<double> truth;
    for (int i = 0; i < 200; ++i) {
        const double angle = 0.011 + 0.0031 * i;
        const double r = radius_below_pane(angle);
        const Vec3d at(lamp.x() + r * std::cos(2.4 * i), lamp.y() + r * std::sin(2.4 * i), 0);
        points.push_back(support::probe(scene, 1, at, Vec3d::UnitZ(), points.size()));
        truth.push_back(irradiance_below_pane(angle, spot));
    }
    beamtree::BeamTreeParams params;
    params.max_bounces = 2;
    params.intensity = intensity;
    const auto found = support::irradiance(*build(scene, params, {}), points);
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        largest =
            std::max(largest, std::abs(static_cast<double>(found[i].value.mean()) / truth[i] - 1));
    return largest;
}

TEST(BeamRefined, IsTheClosedFormBehindAPaneOfTwelveTriangles) {
    EXPECT_GT(error_below_pane(false, beamtree::Intensity::area), 0.05);
    EXPECT_LT(error_below_pane(false, beamtree::Intensity::refined), 0.01);
    // The spot's falloff has a bend within a polygon.
    EXPECT_GT(error_below_pane(true, beamtree::Intensity::area), 0.1);
    EXPECT_LT(error_below_pane(true, beamtree::Intensity::refined), 0.03);
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
            for (const beamtree::Intensity intensity :
                 {beamtree::Intensity::area, beamtree::Intensity::refined}) {
                const Errors e = truth.errors(meshed(mesh), with(intensity));
                std::printf(" %.5f | %.5f |", e.median, e.mean);
            }
        std::printf("\n");
    }
}

}  // namespace
}  // namespace caustics

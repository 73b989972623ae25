#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

// Beams that straddle the receiver's horizon: a coarse mirror stands on the floor and reaches above
// the light, so that some corners of its polygons send light down and others up.
const Vec3d image(0.1, 2, 1);  // of the light, behind the mirror |x| <= 1, 0 <= z <= 2 at y = 1

// `turn`: of the normal at every other vertex of the mesh.
Scene standing_mirror(int resolution, float turn = 0) {
    SceneDesc desc;
    const Bsdf bsdf = support::mirror();
    const Shape wall = support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, bsdf);
    TriangleMesh mesh = tessellate_rectangle(resolution);
    for (std::size_t i = 0; i < mesh.normals.size(); i += 2) mesh.normals[i].x() = turn;
    desc.shapes = {support::horizontal("floor", 0, 6, true, support::diffuse(0.5F)),
                   support::mesh("mirror", mesh, wall.to_world, bsdf)};
    desc.lights = {support::point_light({image.x(), 2 - image.y(), image.z()}, 1)};
    return Scene(std::move(desc));
}

double by_the_image(const Vec3d& p) {
    const Vec3d w = image - p;
    const Vec3d crossing = p + (1 - p.y()) / w.y() * w;
    const bool inside = std::abs(crossing.x()) < 1 && crossing.z() > 0 && crossing.z() < 2;
    return inside ? w.z() / std::pow(w.norm(), 3) : 0;
}

struct Agreement {
    double mean_ratio;
    double relative_error;  ///< root of the mean of (x - r)^2 over that of r^2
};

Agreement on_the_floor(const Scene& scene, const CausticEstimator& method) {
    constexpr int side = 40;
    double found = 0;
    double expected = 0;
    double square = 0;
    double expected_square = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const Vec3d p(3 * (i + 0.5) / side - 1.5, 0.99 - 3 * (j + 0.5) / side, 0);
            const auto point = support::probe(scene, 0, p, Vec3d::UnitZ(), 0);
            const auto x =
                static_cast<double>(support::irradiance(method, {point})[0].value.mean());
            const double r = by_the_image(p);
            found += x;
            expected += r;
            square += (x - r) * (x - r);
            expected_square += r * r;
        }
    return {found / expected, std::sqrt(square / expected_square)};
}

// Of coarse polygons little is asked, but all that light once came out as nothing.
TEST(BeamHorizon, AStandingMirrorOfAnyResolutionLightsTheFloor) {
    double last = 1;
    for (const int resolution : {1, 3, 8, 32}) {
        const Scene scene = standing_mirror(resolution);
        const double allowed = resolution < 4 ? 0.09 : 0.3 / resolution;
        for (const auto leaf :
             {beamtree::BeamTreeParams::Leaf::receiver, beamtree::BeamTreeParams::Leaf::fixed}) {
            beamtree::BeamTreeParams params = beamtree::BeamTreeParams::chuang1995();
            params.leaf = leaf;
            const Agreement own = on_the_floor(scene, *build(scene, params, {}));
            EXPECT_NEAR(own.mean_ratio, 1, allowed) << resolution;
            EXPECT_LT(own.relative_error, resolution < 4 ? 0.4 : 2.0 / resolution) << resolution;
            last = own.relative_error;
        }
        const Agreement watt =
            on_the_floor(scene, *build(scene, beamtree::CausticPolygonsParams{}, {}));
        EXPECT_NEAR(watt.mean_ratio, 1, allowed) << resolution;
    }
    EXPECT_LT(last, 0.03);
}

// Flat facets are planes, wherever the light comes down.
TEST(BeamHorizon, RefinedIntensityIsExactOnFlatFacets) {
    beamtree::BeamTreeParams params = beamtree::BeamTreeParams::chuang1995();
    params.intensity = beamtree::Intensity::refined;
    for (const int resolution : {8, 32}) {
        const Scene scene = standing_mirror(resolution);
        const Agreement found = on_the_floor(scene, *build(scene, params, {}));
        EXPECT_NEAR(found.mean_ratio, 1, 1e-6) << resolution;
        EXPECT_LT(found.relative_error, 1e-6) << resolution;
    }
}

// Normals that differ by a rounding make a smooth mesh; its roots go by these normals, and are off the flat mirror's by
// no more than they.
TEST(BeamHorizon, RefinedIntensityGoesByNormalsThatDifferByARounding) {
    beamtree::BeamTreeParams params = beamtree::BeamTreeParams::chuang1995();
    params.intensity = beamtree::Intensity::refined;
    for (const int resolution : {16, 32, 64}) {
        const Scene scene = standing_mirror(resolution, 1e-7F);
        const Agreement found = on_the_floor(scene, *build(scene, params, {}));
        EXPECT_NEAR(found.mean_ratio, 1, 1e-3) << resolution;
        EXPECT_LT(found.relative_error, 1e-3) << resolution;
    }
}

}  // namespace
}  // namespace caustics

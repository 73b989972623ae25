#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "beamtree/beam_tree.h"
#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"
#include "tests/support/flat_pool.h"

namespace caustics {
namespace {

// A lamp much nearer to a caster than its polygons are wide: nearly all of the light goes through the
// middle of one of them.

constexpr std::size_t floor_shape = 0;
// Off the mesh's vertices and edges.
constexpr double lamp_x = 0.013;
constexpr double lamp_y = 0.021;

/// Of the found over the true irradiance.
struct Ratio {
    double mean = 0;
    double worst = 0;  ///< off 1
};

template <typename Truth>
Ratio ratio(const Scene& scene, const CausticEstimator& method, double floor_z,
            const Truth& truth) {
    Ratio ratio;
    constexpr int count = 64;
    for (int i = 0; i < count; ++i) {
        const double r = 0.05 + 0.75 * i / count;
        const double angle = 2.4 * i;
        const Vec3d p(lamp_x + r * std::cos(angle), lamp_y + r * std::sin(angle), floor_z);
        const ReceiverPoint point = support::probe(scene, floor_shape, p, Vec3d::UnitZ(), 0);
        const double one =
            static_cast<double>(support::irradiance(method, {point})[0].value.mean()) / truth(r);
        ratio.mean += one / count;
        ratio.worst = std::max(ratio.worst, std::abs(one - 1));
    }
    return ratio;
}

Scene lamp_over_water(double light, bool mesh) {
    using namespace support::flat_pool;
    Shape water = support::horizontal("water", 0, 3, true, support::glass(1.333F));
    if (mesh) water = support::mesh("water", tessellate_rectangle(64), water.to_world, water.bsdf);
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -depth, 5, true, support::diffuse(0.5F)), water};
    desc.lights = {support::point_light({lamp_x, lamp_y, light}, static_cast<float>(intensity))};
    return Scene(std::move(desc));
}

TEST(NearLamp, ShinesThroughWaterAsItDoesFromAfar) {
    for (const bool mesh : {true, false})
        for (const double light : {0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6})
            for (const beamtree::PolygonKind kind :
                 {beamtree::PolygonKind::triangle, beamtree::PolygonKind::quad}) {
                const Scene scene = lamp_over_water(light, mesh);
                beamtree::BeamTreeParams params;
                params.polygons = kind;
                const auto tree = build(scene, params, {});
                const Ratio found = ratio(scene, *tree, -support::flat_pool::depth, [&](double r) {
                    return support::flat_pool::floor_irradiance(r, light);
                });
                EXPECT_NEAR(found.mean, 1, 0.02) << light;
                EXPECT_LT(found.worst, 0.12) << light;
                // Reflected and refracted beams of 8192 triangles, and three times as many at most.
                EXPECT_LT(tree->build_report().counters["beams"], 3 * 2 * 8192U) << light;
            }
}

// Waves so slight that the floor's light is that of still water, on a mesh so coarse that edges are just flat, just
// not flat, and both in one triangle.
TEST(NearLamp, ShinesThroughCoarseWaterThatIsHardlyFlat) {
    using namespace support::flat_pool;
    for (const double amplitude : {3e-4, 4e-4, 1e-3, 3e-3})
        for (const double light : {1.0, 0.5, 0.2}) {
            SineHeightfield field;
            field.half_size = Vec2d::Constant(3);
            field.waves = {{amplitude, {3, 1}, 0}};
            SceneDesc desc;
            desc.shapes = {support::horizontal("floor", -depth, 5, true, support::diffuse(0.5F)),
                           support::mesh("water", tessellate_heightfield(field, {24, 24}),
                                         Transform::Identity(), support::glass(1.333F))};
            desc.lights = {
                support::point_light({lamp_x, lamp_y, light}, static_cast<float>(intensity))};
            const Scene scene(std::move(desc));
            const auto tree = build(scene, beamtree::BeamTreeParams{}, {});
            const Ratio found =
                ratio(scene, *tree, -depth, [&](double r) { return floor_irradiance(r, light); });
            // Water focuses by 1 + (n - 1) depth times its curvature or less.
            const double focus = 0.333 * depth * 10 * amplitude;
            EXPECT_NEAR(found.mean, 1, 0.01 + focus) << amplitude << ' ' << light;
            EXPECT_LT(found.worst, 0.05 + 2 * focus) << amplitude << ' ' << light;
        }
}

// A curtain of water 1e17 m high a millimetre past a lamp needs as many pieces as it is longer than wide.
TEST(NearLamp, RefusesPolygonsThatNeedTooManyPieces) {
    SineHeightfield field;
    field.waves = {{1e17, {3, 1}, 0}};
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -1, 1, true, support::diffuse(0.5F)),
                   support::mesh("curtain", tessellate_heightfield(field, {16, 16}),
                                 Transform::Identity(), support::glass(1.333F))};
    desc.lights = {support::point_light({0.001, 0, 3}, 1)};
    const Scene scene(std::move(desc));
    for (const int threads : {1, 2}) {
        RunOptions options;
        options.threads = threads;
        try {
            build(scene, beamtree::BeamTreeParams::chuang1995(), options);
            FAIL() << "not refused";
        } catch (const UnsupportedScene& refusal) {
            EXPECT_EQ(
                std::string(refusal.what()),
                "curtain: the light at (0.001, 0, 3) is so near to polygons so long that beams "
                "would need more than 1048576 pieces of them (give them a more even length "
                "and width, move the light away, or use photonmap)");
        }
    }
}

/// A light this far below a mirror of this half size.
Ratio ratio_below_mirror(double half, double light, const beamtree::BeamTreeParams& params) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 5, true, support::diffuse(0.5F)),
                   support::horizontal("mirror", 2, half, false, support::mirror())};
    desc.lights = {support::point_light({lamp_x, lamp_y, 2 - light}, 10)};
    const Scene scene(std::move(desc));
    // From the image of the light: I h / d^3.
    return ratio(scene, *build(scene, params, {}), 0, [&](double r) {
        const double h = 2 + light;
        return 10 * h / std::pow(r * r + h * h, 1.5);
    });
}

TEST(NearLamp, ShinesFromALargeMirrorAsItDoesFromAfar) {
    for (const double half : {1.5, 20.0})
        for (const double light : {0.01, 1e-3, 1e-4, 1e-5, 1e-6}) {
            const Ratio found =
                ratio_below_mirror(half, light, beamtree::BeamTreeParams::chuang1995());
            EXPECT_NEAR(found.mean, 1, 0.04) << half << ' ' << light;
            EXPECT_LT(found.worst, 0.25) << half << ' ' << light;
        }
}

TEST(NearLamp, ShinesFromALargeMirrorToRoundingWhereItIsRefined) {
    for (const double half : {1.5, 5.0, 20.0, 100.0})
        for (const double light : {0.01, 1e-3, 1e-4, 1e-5, 1e-6}) {
            const Ratio found = ratio_below_mirror(half, light, {});
            EXPECT_NEAR(found.mean, 1, 1e-6) << half << ' ' << light;
            EXPECT_LT(found.worst, 1e-6) << half << ' ' << light;
        }
}

/// A lamp in a mirror ball, or outside of it, so far from its wall, above a dish in the ball.
Scene ball_with_lamp(double from_wall) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("dish", -0.3, 0.4, true, support::diffuse(0.5F)),
                   support::sphere("ball", Vec3d::Zero(), 1, support::mirror())};
    const Vec3d towards = Vec3d(0.31, 0.42, 0.74).normalized();
    const Vec3d place = (1 - from_wall) * towards;
    desc.lights = {support::point_light(place, 1)};
    return Scene(std::move(desc));
}

// Polygons of a ball bulge by up to 3e-4 of its radius, or by a sixteenth of that.
TEST(NearLamp, IsRefusedWhereItIsBehindThePolygonsOfACurvedMirror) {
    beamtree::BeamTreeParams coarse;
    coarse.mesh_resolution = 64;
    coarse.max_bounces = 1;
    for (const double from_wall : {2e-5, 5e-5}) {
        const Scene scene = ball_with_lamp(from_wall);
        try {
            build(scene, coarse, {});
            ADD_FAILURE() << "not refused: " << from_wall;
        } catch (const UnsupportedScene& refusal) {
            const std::string text = refusal.what();
            EXPECT_TRUE(text.starts_with("ball: the light at (")) << text;
            EXPECT_NE(text.find("take a mesh_resolution"), std::string::npos) << text;
        }
    }
    for (const double from_wall : {2e-3, -2e-5, -2e-3})
        EXPECT_NO_THROW(build(ball_with_lamp(from_wall), coarse, {})) << from_wall;
}

// No side of a surface is that of a light that lies on it.
TEST(NearLamp, IsRefusedOnACaster) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 5, true, support::diffuse(0.5F)),
                   support::horizontal("mirror", 2, 3, false, support::mirror())};
    desc.lights = {support::point_light({lamp_x, lamp_y, 2}, 10)};
    try {
        build(Scene(std::move(desc)), beamtree::BeamTreeParams{}, {});
        FAIL() << "not refused";
    } catch (const UnsupportedScene& refusal) {
        EXPECT_EQ(std::string(refusal.what()),
                  "beamtree: the light at (0.013, 0.021, 2) lies on mirror, and on which of its "
                  "sides it shines is not known (move it to one side, by a millionth of its "
                  "coordinates or more)");
    }
}

}  // namespace
}  // namespace caustics

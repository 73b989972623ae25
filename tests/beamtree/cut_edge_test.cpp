#include "beamtree/tracing/cut_edge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beams/light_sample.h"
#include "tests/support/build_scene.h"

namespace caustics::beamtree {
namespace {

constexpr int half_width = 1;
constexpr int height = 2;
// Of the light in the glass, sideways over downwards.
constexpr double slope = 0.2;
// From here on it meets a side instead of the bottom.
constexpr auto edge_above = static_cast<float>(half_width - height * slope);

// With facets of its own, its top at 0.
TriangleMesh box() {
    TriangleMesh mesh;
    for (const int z : {-height, 0})
        for (const int y : {-half_width, half_width})
            for (const int x : {-half_width, half_width}) mesh.positions.emplace_back(x, y, z);
    mesh.triangles = {{4, 5, 7}, {4, 7, 6}, {0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4},
                      {2, 7, 3}, {2, 6, 7}, {1, 3, 7}, {1, 7, 5}, {0, 6, 2}, {0, 4, 6}};
    return mesh;
}

SceneDesc box_desc() {
    SceneDesc desc;
    const double in_glass = std::sqrt(2.0) * slope / std::sqrt(1 + 2.0 * slope * slope);
    const double outside = 1.5 * in_glass;
    desc.shapes = {support::mesh("box", box(), Transform::Identity(), support::glass(1.5F)),
                   support::horizontal("floor", -3, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::directional_light(
        {outside / std::sqrt(2.0), outside / std::sqrt(2.0), -std::sqrt(1 - outside * outside)},
        1)};
    return desc;
}

// Light that comes into the top of the box.
struct CutEdges : testing::Test {
    Scene scene{box_desc()};
    std::vector<CasterMesh> casters = caster_meshes(scene, 8);
    LightSample light = sample_lights(scene, 1, 1).front();
    LitCaster surface{scene, casters.front(), light};
    Level level = first_level();
    Path path{scene, surface, level, 0};

    static Level first_level() {
        Level first;
        first.event = refraction;
        first.traced.set.beams.resize(1);  // on the top
        return first;
    }

    PathPoint at(float x, float y) const {
        RayOrigin origin{{x, y, 0}, Vec3::UnitZ()};
        origin.offset = surface.offset(0);
        return path.inside({&origin, &origin, &origin}, Vec3::UnitX());
    }
};

TEST_F(CutEdges, StraddleTheLineBetweenFacets) {
    const PathPoint bottom = at(-0.5F, 0.1F);
    const PathPoint side = at(0.9F, -0.3F);
    ASSERT_TRUE(goes_on(bottom));
    ASSERT_TRUE(goes_on(side));
    EXPECT_NEAR(bottom.next.position.z(), -height, 1e-6);
    EXPECT_NEAR(side.next.position.x(), half_width, 1e-6);
    for (const int halvings : {1, 4, 9, most_halvings}) {
        const CutEdge edge = cut_edge(path, bottom, side, halvings, false);
        ASSERT_TRUE(edge.is_cut);
        EXPECT_FALSE(edge.hides_another);
        EXPECT_TRUE(alike(edge.last, bottom));
        EXPECT_TRUE(alike(edge.first, side));
        const float last = edge.last.origin.position.x();
        const float first = edge.first.origin.position.x();
        EXPECT_LE(last, edge_above + 1e-6F);
        EXPECT_GE(first, edge_above - 1e-6F);
        EXPECT_LE(first - last, 1.4F * std::ldexp(1.0F, -halvings) + 1e-6F);
    }
}

TEST_F(CutEdges, AreTheSameFromBothEnds) {
    const PathPoint bottom = at(-0.5F, 0.1F);
    const PathPoint side = at(0.9F, -0.3F);
    const CutEdge there = cut_edge(path, bottom, side, 11, false);
    const CutEdge back = cut_edge(path, side, bottom, 11, false);
    EXPECT_EQ(there.last.origin.position, back.first.origin.position);
    EXPECT_EQ(there.first.origin.position, back.last.origin.position);
}

TEST_F(CutEdges, FindAThirdFacetBetween) {
    const PathPoint one = at(-0.5F, 0.9F);
    const PathPoint other = at(0.9F, -0.5F);
    EXPECT_NEAR(one.next.position.y(), half_width, 1e-6);
    EXPECT_NEAR(other.next.position.x(), half_width, 1e-6);
    const CutEdge edge = cut_edge(path, one, other, most_halvings, false);
    EXPECT_TRUE(edge.is_cut);
    EXPECT_TRUE(edge.hides_another);
    EXPECT_NEAR(edge.last.origin.position.y(), edge_above, 2e-4);
    EXPECT_NEAR(edge.first.origin.position.x(), edge_above, 2e-4);
    EXPECT_TRUE(cut_edge(path, one, other, most_halvings, true).hides_another);
}

TEST_F(CutEdges, AreNotCutWhereBothEndsDoTheSame) {
    EXPECT_FALSE(cut_edge(path, at(-0.5F, 0.1F), at(0.2F, -0.3F), 9, false).is_cut);
}

}  // namespace
}  // namespace caustics::beamtree

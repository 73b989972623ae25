#include "beamtree/beams/ray_spread.h"

#include <gtest/gtest.h>

#include "beamtree/light/refined_density.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

std::vector<BeamSet> refined_sets(const Scene& scene, const std::vector<CasterMesh>& casters) {
    return trace_all_beams(scene, casters, sample_lights(scene, 1, 1), {Intensity::refined}, {})
        .sets;
}

// Behind a plane mirror light spreads from the lamp's image: (d + s)^2 / (I R) in all.
TEST(RaySpread, IsThatOfTheImageBehindAPlaneMirror) {
    SceneDesc desc;
    desc.shapes = {support::mesh("mirror", tessellate_rectangle(64), Transform::Identity(),
                                 support::mirror(0.8F))};
    const Vec3 lamp(0.1F, 0.2F, 0.9F);
    desc.lights = {support::point_light(lamp.cast<double>(), 3)};
    const Scene scene(std::move(desc));
    const auto sets = refined_sets(scene, caster_meshes(scene, 2));
    ASSERT_EQ(sets.size(), 1U);
    ASSERT_EQ(sets[0].spreads.size(), sets[0].rays.size());
    const double intensity = 3 * 0.8;
    for (std::size_t i = 0; i < sets[0].rays.size(); ++i) {
        ASSERT_TRUE(sets[0].spreads[i].is_known());
        const auto d = static_cast<double>((sets[0].rays[i].position - lamp).norm());
        for (const double s : {0.0, 0.5, 4.0})
            ASSERT_NEAR(sets[0].spreads[i].at(s) * intensity / ((d + s) * (d + s)), 1, 3e-3);
    }
}

// Parallel light on a concave mirror: spreads vanish where it is focused, at half of the radius.
TEST(RaySpread, ChangesItsSignAtTheFocus) {
    SineHeightfield bowl;  // near the middle a paraboloid z = -a cos(k x) cos(k y), R = 1 / (a k^2)
    bowl.waves = {{0.125, {0.4, 0.4}, -pi_d / 2}, {0.125, {0.4, -0.4}, -pi_d / 2}};
    SceneDesc desc;
    desc.shapes = {support::mesh("bowl", tessellate_heightfield(bowl, 32), Transform::Identity(),
                                 support::mirror())};
    desc.lights = {support::directional_light({0, 0, -1}, 2)};
    const Scene scene(std::move(desc));
    const auto sets = refined_sets(scene, caster_meshes(scene, 2));
    const double focus = 1 / (0.25 * 0.16) / 2;
    bool found = false;
    for (std::size_t i = 0; i < sets[0].rays.size(); ++i) {
        if (sets[0].rays[i].position.head<2>().norm() > 1e-6F) continue;
        const RaySpread& spread = sets[0].spreads[i];
        found = true;
        EXPECT_NEAR(static_cast<double>(spread.constant), 0.5, 1e-4);
        EXPECT_NEAR(-static_cast<double>(spread.linear / spread.quadratic) / 2, focus,
                    0.01 * focus);
        EXPECT_NEAR(spread.at(focus), 0, 1e-4);
    }
    EXPECT_TRUE(found);
}

// The two triangles of a cell belong together; elsewhere those that make up a parallelogram.
TEST(MeshNeighbours, PairsTriangles) {
    SceneDesc desc = pool_desc(4);
    desc.shapes.push_back(desc.shapes[0]);
    desc.shapes[2].mesh.patches.clear();
    for (Vec3& p : desc.shapes[2].mesh.positions) p.z() += 1;
    const Scene scene(std::move(desc));
    const auto casters = caster_meshes(scene, 2);
    const MeshNeighbours cells(casters[0]);
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(cells.partner(i), i ^ 1U);
    const MeshNeighbours others(casters[1]);
    int paired = 0;
    for (std::uint32_t i = 0; i < 32; ++i) {
        const std::uint32_t other = others.partner(i);
        if (other == MeshNeighbours::none) continue;
        ++paired;
        EXPECT_EQ(others.partner(other), i);
        EXPECT_NE(other, i);
    }
    EXPECT_GE(paired, 24);
    const auto round = cells.round(0);
    EXPECT_GE(round.size(), 2U);
    EXPECT_TRUE(std::is_sorted(round.begin(), round.end()));
}

// Flat facets share no vertices: nothing tells how their light spreads, and eq. 11 does.
TEST(RaySpread, IsNotKnownOnFlatFacets) {
    SceneDesc desc = pool_desc(4);
    desc.shapes[0].mesh = support::flat(desc.shapes[0].mesh);
    const Scene scene(std::move(desc));
    for (const BeamSet& set : refined_sets(scene, caster_meshes(scene, 2))) {
        for (const RaySpread& spread : set.spreads) EXPECT_FALSE(spread.is_known());
        BeamHit hit;
        hit.plane_normal = Vec3::UnitZ();
        hit.weights = Vec3::Constant(1.0F / 3);
        EXPECT_FALSE(refined_density(set, hit, {0, 0, -1}));
    }
}

}  // namespace
}  // namespace caustics::beamtree

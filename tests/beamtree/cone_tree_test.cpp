#include "beamtree/cones/cone_tree.h"
#include "beamtree/beams/binned_hierarchy.h"
#include "beamtree/beams/quadtree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "beamtree/cones/cone_merging.h"
#include "beamtree/cones/plane_groups.h"
#include "core/math/sampling.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

Vec3 random_direction(Rng& rng) { return uniform_cap(2, rng.next(), rng.next()).normalized(); }

// Two rays side by side at the rim of the neck lean to and fro along it: a tilted plane meets both farther out, and what lies
// between these places lies outside of a cone without slack.
TEST(DoubleCone, NeedsItsSlackOnTiltedPlanes) {
    constexpr double aside = 0.3;
    const double slope = std::tan(0.4);
    const double x = std::sin(aside), y = std::cos(aside);
    NodeRays rays;
    for (const auto& [at, dy] :
         {std::pair(Vec3d(-x, y, 0), -slope), {Vec3d(x, y, 0), slope}, {Vec3d(0, -1, 0), 0.0}}) {
        const Vec3d way(0, dy, -1);
        rays.positions.push_back(at - 3 * way);
        rays.directions.push_back(way.normalized());
    }
    rays.triangles = {{0, 1, 2}};
    BeamSet set;
    for (std::size_t i = 0; i < 3; ++i)
        set.rays.push_back({rays.positions[i].cast<float>(), rays.directions[i].cast<float>()});
    Beam beam;
    beam.corners = {0, 1, 2, Beam::none};
    set.beams = {beam};
    const DoubleCone cone = double_cone(rays, smallest_cap(rays.directions), 6);
    ASSERT_TRUE(cone.exists());
    Rng rng(1, Stage::test, 0);
    int hits = 0;
    int beyond = 0;
    for (int i = 0; i < 100'000; ++i) {
        const float angle = 6.2832F * rng.next();
        const float tilt = 0.3F + 0.35F * rng.next();
        const Vec3 normal(std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle),
                          std::cos(tilt));
        const Vec3 point(0.8F * rng.next() - 0.4F, 0.9F + 0.2F * rng.next(),
                         0.1F * rng.next() - 0.05F);
        const TestPlane plane(point, normal);
        std::array<BeamHit, 2> found;
        const std::optional<bool> held = cone.holds(plane.point(), plane.normal());
        if (!held || test_beam(set, beam, plane, found) == 0) continue;
        ++hits;
        EXPECT_TRUE(*held) << point.transpose() << " / " << normal.transpose();
        const Vec3d v = (point - cone.neck).cast<double>();
        const double along = v.dot(cone.axis.cast<double>());
        beyond += (v - along * cone.axis.cast<double>()).norm() >
                  static_cast<double>(cone.radius) +
                      std::abs(along) * static_cast<double>(cone.tangent) + 1e-5;
    }
    EXPECT_GT(hits, 5'000);
    EXPECT_GT(beyond, 100);
}

// [CC95 (5)] to [CC95 (10)], corrected: points of the ellipse lie on the cone and on the plane.
TEST(ConeSection, LiesOnTheConeAndThePlane) {
    Rng rng(4, Stage::test, 0);
    int ellipses = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d apex = random_direction(rng).cast<double>();
        const Vec3d plane_axis = random_direction(rng).cast<double>().normalized();
        const Vec3d cone_axis = random_direction(rng).cast<double>().normalized();
        const double spread = 0.05 + static_cast<double>(rng.next());
        const double height = 4 * static_cast<double>(rng.next()) - 2;
        const auto section = cone_section(apex, cone_axis, spread, plane_axis, height);
        const double between = std::acos(std::clamp(cone_axis.dot(plane_axis), -1.0, 1.0));
        EXPECT_EQ(section.has_value(), between + spread < pi_d / 2);
        if (!section || between + spread > 1.5) continue;
        ++ellipses;
        const Vec3d minor_axis = section->major_axis.cross(plane_axis);
        for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
            const Vec3d p = section->centre +
                            section->major * std::cos(angle) * section->major_axis +
                            section->minor * std::sin(angle) * minor_axis;
            EXPECT_NEAR((p - apex).dot(plane_axis), height, 1e-11);
            const double along = std::abs((p - apex).dot(cone_axis));
            EXPECT_NEAR(along, std::cos(spread) * (p - apex).norm(), 1e-10 * (1 + along));
        }
    }
    EXPECT_GT(ellipses, 200);
}

void expect_every_beam_once(const Hierarchy& tree, std::vector<std::uint32_t> beams) {
    std::vector<std::uint32_t> order = tree.order;
    std::sort(order.begin(), order.end());
    std::sort(beams.begin(), beams.end());
    EXPECT_EQ(order, beams);
    std::size_t leaves = 0;
    for (const Hierarchy::Node& node : tree.nodes) {
        leaves += node.child_count == 0;
        EXPECT_TRUE(node.child_count > 0 || node.beam_count == 1);
        std::uint32_t next = node.first_beam;
        for (std::uint32_t c = 0; c < node.child_count; ++c) {
            const Hierarchy::Node& child = tree.nodes[node.first_child + c];
            EXPECT_EQ(child.first_beam, next);
            next += child.beam_count;
        }
        if (node.child_count > 0) {
            EXPECT_EQ(next, node.first_beam + node.beam_count);
        }
    }
    EXPECT_EQ(leaves, beams.size());
}

TEST(Hierarchy, HoldsEveryBeamOnce) {
    for (const int resolution : {1, 5, 8, 32}) {
        const BeamScene pool("pool", pool_desc(resolution));
        const BeamSet& set = pool.sets[0];
        const auto beams = receiver_planes(set)[0].beams;
        expect_every_beam_once(quadtree(set, beams, pool.casters[0].mesh.patches), beams);
        expect_every_beam_once(binned_hierarchy(set, beams, 1), beams);
        // Quarters down to a cell, then its triangles; those of coarser meshes are split.
        if (resolution == 32) {
            EXPECT_EQ(quadtree(set, beams, pool.casters[0].mesh.patches).height(), 7U);
        }
    }
}

TEST(ConeTree, TellsTheMemoryOfItsBounds) {
    const BeamScene pool("pool", pool_desc(8));
    const BeamSet& set = pool.sets[0];
    const Hierarchy hierarchy = binned_hierarchy(set, receiver_planes(set)[0].beams, 1);
    const auto bytes_per_node = [&](Bound bound) {
        const ConeTree tree(set, 0, hierarchy, {.bound = bound}, Vec3(Vec3::UnitZ()));
        EXPECT_EQ(tree.node_count(), hierarchy.nodes.size());
        return tree.bytes() / tree.node_count();
    };
    const std::uint64_t swept = bytes_per_node(Bound::sphere_swept);
    EXPECT_GE(swept, sizeof(SweptSphere));
    EXPECT_LE(swept, sizeof(SweptSphere) + 32);  // and the node itself
    const std::uint64_t doubles = bytes_per_node(Bound::double_cone);
    EXPECT_EQ(doubles, swept + sizeof(DoubleCone));
    const std::uint64_t singles = bytes_per_node(Bound::single);
    EXPECT_EQ(singles, swept - sizeof(SweptSphere) + sizeof(SingleCone));
}

// A mesh may have more triangles than its patches, and a triangle any number of beams.
TEST(Hierarchy, HoldsBeamsOutsideOfThePatchesAndManyOfOneTriangle) {
    const BeamScene pool("pool", pool_desc(8));
    const std::vector<GridPatch> whole = pool.casters[0].mesh.patches;
    std::vector<GridPatch> half = whole;
    half[0].rows /= 2;
    for (const std::size_t repeated : {1U, 3U, 20U}) {
        BeamSet set = pool.sets[0];
        set.beams.clear();
        for (const Beam& beam : pool.sets[0].beams) {
            const std::size_t count = beam.triangle % 5 == 0 ? repeated : 1;
            set.beams.insert(set.beams.end(), count, beam);
        }
        const auto beams = receiver_planes(set)[0].beams;
        for (const auto& patches : {whole, half}) {
            const Hierarchy tree = quadtree(set, beams, patches);
            expect_every_beam_once(tree, beams);
            EXPECT_LE(tree.height(), 14U);
        }
        // None of its patches has a beam of this group.
        const std::span<const std::uint32_t> last(beams.data() + beams.size() - 6, 6);
        expect_every_beam_once(quadtree(set, last, half), {last.begin(), last.end()});
    }
}

const BeamSet& refracted(const BeamScene& scene) {
    return *std::ranges::find_if(scene.sets, [](const BeamSet& set) { return set.refracted; });
}

// Nodes of narrow caps are told by a single cone, others by two: which is which says a scan over the nodes' rays.
TEST(ConeTree, OfTheHybridBoundHasSingleConesBelowTheThreshold) {
    const BeamScene pool("pool", pool_desc(8));
    const BeamSet& set = refracted(pool);
    const Hierarchy hierarchy = binned_hierarchy(set, receiver_planes(set)[0].beams, 1);
    const auto bytes = [&](Bound bound, double threshold) {
        const ConeTreeSettings settings{.bound = bound, .spread_threshold = threshold};
        return ConeTree(set, 0, hierarchy, settings, Vec3(Vec3::UnitZ())).bytes();
    };
    const std::uint64_t swept = hierarchy.nodes.size() * sizeof(SweptSphere);
    const std::uint64_t of_nodes = bytes(Bound::sphere_swept, 0) - swept;
    for (const double threshold : {0.0, 1.0, 3.0, 10.0, 60.0}) {
        std::uint64_t narrow = 0;
        for (const Hierarchy::Node& node : hierarchy.nodes)
            narrow +=
                smallest_cap(
                    rays_of(set,
                            std::span(hierarchy.order).subspan(node.first_beam, node.beam_count))
                        .directions)
                    .angle() < threshold * pi_d / 180;
        const std::uint64_t wide = hierarchy.nodes.size() - narrow;
        if (threshold == 3) {
            EXPECT_GT(narrow, 10U);
            EXPECT_GT(wide, 10U);
        }
        EXPECT_EQ(bytes(Bound::hybrid, threshold) - of_nodes,
                  narrow * sizeof(SingleCone) + wide * (sizeof(SweptSphere) + sizeof(DoubleCone)))
            << threshold;
    }
}

// README.md: a parent by its own rays is tighter than one by its children's cones.
TEST(ConeTree, AsksFewerNodesWhereParentsAreMadeOfTheirRays) {
    const BeamScene pool("pool", pool_desc(16));
    const BeamSet& set = refracted(pool);
    const Hierarchy hierarchy = binned_hierarchy(set, receiver_planes(set)[0].beams, 1);
    const auto tests = [&](ConeTreeSettings::Merging merging) {
        const ConeTree tree(set, 0, hierarchy,
                            {.bound = Bound::double_cone, .merging = merging, .reach = 2},
                            Vec3(Vec3::UnitZ()));
        Rng rng(2, Stage::test, 0);
        std::vector<std::uint32_t> stack;
        std::vector<BeamHit> hits;
        SearchCounts counts;
        for (int i = 0; i < 2000; ++i)
            tree.find(set, {2 * rng.next() - 1, 2 * rng.next() - 1, -1}, Vec3::UnitZ(), stack, hits,
                      counts);
        EXPECT_GT(hits.size(), 1000U);
        return counts.cone_point_tests;
    };
    EXPECT_LT(tests(ConeTreeSettings::Merging::rays), tests(ConeTreeSettings::Merging::cones));
}

}  // namespace
}  // namespace caustics::beamtree

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>

#include "beamtree/beams/binned_hierarchy.h"
#include "beamtree/beams/quadtree.h"
#include "beamtree/cones/cone_tree.h"
#include "beamtree/cones/plane_groups.h"
#include "beamtree/light/find_in_beam.h"
#include "beamtree/slices/slice_tree.h"
#include "core/math/sampling.h"
#include "tests/beamtree/beam_scenes.h"
#include "tests/support/sanitizers.h"

namespace caustics::beamtree {
namespace {

/// Where a tree is asked.
struct Query {
    Vec3 point;
    Vec3 normal;
};

Vec3 random_direction(Rng& rng) { return uniform_cap(2, rng.next(), rng.next()).normalized(); }

// A quarter of the points anywhere round the scene, the others in a beam at any distance, some of
// them on its edges and corners; planes of any tilt that face some beam.
std::vector<Query> random_queries(const BeamScene& scene, const BeamSet& set, int count) {
    std::vector<Query> queries;
    Rng rng(7, Stage::test, 0);
    for (int i = 0; i < count; ++i) {
        const Beam& beam = set.beams[rng.next_word() % set.beams.size()];
        const auto rays = set.triangle(beam, 0);
        const float u = i % 16 == 1 ? 1 : std::sqrt(rng.next());
        const float v = i % 8 == 1 ? 0 : rng.next();
        const Vec3 weights(1 - u, u * (1 - v), u * v);
        Vec3 from = Vec3::Zero();
        Vec3 along = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            from += weights[k] * rays[static_cast<std::size_t>(k)]->position;
            along += weights[k] * rays[static_cast<std::size_t>(k)]->direction;
        }
        const float distance = 2 * rng.next() * rng.next();
        Query query{from + distance * along, random_direction(rng)};
        if (query.normal.dot(along) > 0) query.normal = -query.normal;
        if (i % 4 == 3) {
            const Vec3 share(rng.next(), rng.next(), rng.next());
            query.point = scene.scene.bounds().min() +
                          Vec3(share.cwiseProduct(scene.scene.bounds().diagonal()));
        }
        queries.push_back(query);
    }
    return queries;
}

/// A hit: its query, beam, triangle and winding.
using Found = std::vector<std::tuple<std::size_t, std::uint32_t, int, int>>;

void add(std::size_t query, const std::vector<BeamHit>& hits, Found& found) {
    for (const BeamHit& hit : hits) found.emplace_back(query, hit.beam, hit.triangle, hit.winding);
}

/// Points sixteen at a time, so that most beams can be left out by a few multiplications.
using Lane = Eigen::Array<float, 16, 1>;
struct Points {
    std::vector<Lane> x, y, z;

    explicit Points(const std::vector<Query>& queries)
        : x((queries.size() + 15) / 16, Lane::Zero()), y(x), z(x) {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const auto lane = static_cast<Eigen::Index>(i % 16);
            x[i / 16][lane] = queries[i].point.x();
            y[i / 16][lane] = queries[i].point.y();
            z[i / 16][lane] = queries[i].point.z();
        }
    }
};

/// Half-spaces round a beam that know nothing of cones. Every point that the beam-point test can
/// accept is X + V with X in the polygon and V a positive combination of its rays' directions D; so
/// where u.D <= 0 for all of them, u.p <= max u.P over the vertices P.
class Fence {
public:
    Fence(const BeamSet& set, const Beam& beam) {
        std::vector<VertexRay> rays;
        for (const std::uint32_t corner : beam.corners)
            if (corner != Beam::none) rays.push_back(set.rays[corner]);
        Vec3 a = Vec3::Zero();
        for (const VertexRay& ray : rays) a += ray.direction;
        a.normalize();
        for (const VertexRay& ray : rays)
            if (!(ray.direction.dot(a) > 0.1F)) return;  // spreads too far to be fenced
        const Vec3 s = a.unitOrthogonal();
        const Vec3 t = a.cross(s);
        add(-a, rays);
        for (int i = 0; i < 8; ++i) {
            const float angle = 0.7853982F * static_cast<float>(i);
            const Vec3 across = std::cos(angle) * s + std::sin(angle) * t;
            float slope = -std::numeric_limits<float>::infinity();
            for (const VertexRay& ray : rays)
                slope = std::max(slope, across.dot(ray.direction) / a.dot(ray.direction));
            add((across - slope * a).normalized(), rays);
        }
    }

    /// Of the points of one lane, which may lie inside.
    Eigen::Array<bool, 16, 1> holds(const Lane& x, const Lane& y, const Lane& z) const {
        Lane outside = Lane::Constant(-1);
        for (const auto& [u, limit] : planes_)
            outside = outside.max(u.x() * x + u.y() * y + u.z() * z - limit);
        return outside <= 0;
    }

private:
    void add(const Vec3& u, const std::vector<VertexRay>& rays) {
        float limit = -std::numeric_limits<float>::infinity();
        for (const VertexRay& ray : rays) limit = std::max(limit, u.dot(ray.position));
        planes_.emplace_back(u, limit + 1e-4F);
    }

    std::vector<std::pair<Vec3, float>> planes_;
};

void ask(const BeamSet& set, std::uint32_t beam, const PlaneGroup& group,
         const std::vector<Query>& queries, std::size_t i, Found& found) {
    const TestPlane plane(queries[i].point, group.normal ? *group.normal : queries[i].normal);
    std::vector<BeamHit> hits;
    SearchCounts counts;
    find_in_beam(set, {0, beam}, plane, hits, counts);
    add(i, hits, found);
}

// All beams asked at all points, but for those whose fence a point is outside of.
Found scan(const BeamSet& set, const PlaneGroup& group, const std::vector<Query>& queries,
           const Points& points) {
    Found found;
    for (const std::uint32_t beam : group.beams) {
        const Fence fence(set, set.beams[beam]);
        for (std::size_t lane = 0; lane < points.x.size(); ++lane) {
            const auto inside = fence.holds(points.x[lane], points.y[lane], points.z[lane]);
            if (!inside.any()) continue;
            const std::size_t first = 16 * lane;
            for (std::size_t i = first; i < std::min(first + 16, queries.size()); ++i)
                if (inside[static_cast<Eigen::Index>(i - first)])
                    ask(set, beam, group, queries, i, found);
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

// No fence hides a hit: every beam asked at some of the points.
void expect_whole(const BeamSet& set, const PlaneGroup& group, const std::vector<Query>& queries,
                  const Found& truth) {
    for (std::size_t i = 0; i < queries.size(); i += 101) {
        Found found;
        for (const std::uint32_t beam : group.beams) ask(set, beam, group, queries, i, found);
        std::sort(found.begin(), found.end());
        const auto begin =
            std::lower_bound(truth.begin(), truth.end(), Found::value_type(i, 0, 0, -9));
        const auto end = std::lower_bound(begin, truth.end(), Found::value_type(i + 1, 0, 0, -9));
        EXPECT_EQ(found, Found(begin, end));
    }
}

struct Bounds {
    const char* name;
    ConeTreeSettings settings;
};

// Parents from their own rays, and from their children's cones [CC95 (4)].
std::vector<Bounds> all_bounds() {
    using Merging = ConeTreeSettings::Merging;
    std::vector<Bounds> all;
    for (const Merging merging : {Merging::rays, Merging::cones}) {
        const bool rays = merging == Merging::rays;
        all.push_back({rays ? "single" : "single, cones", {Bound::single, 0, merging, 3}});
        all.push_back({rays ? "double" : "double, cones", {Bound::double_cone, 0, merging, 3}});
        all.push_back({rays ? "hybrid" : "hybrid, cones", {Bound::hybrid, 10, merging, 3}});
    }
    all.push_back({"sphere_swept", {Bound::sphere_swept, 0, Merging::rays, 3}});
    return all;
}

/// Appends the hits of one query.
using Find = std::function<void(const Query&, std::vector<BeamHit>&, SearchCounts&)>;

Found search(const Find& find, const std::vector<Query>& queries, SearchCounts& counts) {
    Found found;
    std::vector<BeamHit> hits;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        hits.clear();
        find(queries[i], hits, counts);
        add(i, hits, found);
    }
    EXPECT_LE(counts.beam_point_hits, counts.beam_point_tests);
    EXPECT_LE(counts.beam_point_tests, counts.cone_point_tests);
    std::sort(found.begin(), found.end());
    return found;
}

// How many of `some` are not among `others`; both sorted.
std::size_t missing(const Found& some, const Found& others) {
    Found rest;
    std::set_difference(some.begin(), some.end(), others.begin(), others.end(),
                        std::back_inserter(rest));
    return rest.size();
}

void expect_same(const Found& found, const Found& truth, const std::string& where) {
    EXPECT_EQ(missing(truth, found), 0U) << where;
    EXPECT_EQ(missing(found, truth), 0U) << where;
}

SlicedBeams sliced(const BeamScene& scene, std::uint32_t set, const PlaneGroup& group,
                   const std::vector<std::uint32_t>& beams, const std::vector<Query>& queries) {
    SlicedBeams all{scene.sets, {}, *group.normal, {}};
    for (const std::uint32_t beam : beams) all.beams.push_back({set, beam});
    for (const Query& query : queries) all.receivers.extend(query.point);
    return all;
}

// Trees of slices over both hierarchies, at any height of the slab, on every instruction set: the
// same hits after the same tests.
void expect_slices_as_scan(const BeamScene& scene, std::uint32_t set, const PlaneGroup& group,
                           const std::vector<Query>& queries, const Found& truth) {
    const auto& patches = scene.casters[0].mesh.patches;
    for (const bool regular : {false, true}) {
        if (regular && patches.empty()) continue;
        std::optional<std::uint64_t> tests;
        for (const Isa isa : supported_isas()) {
            const Hierarchy hierarchy =
                regular ? quadtree(scene.sets[set], group.beams, patches) : Hierarchy();
            const SliceTree tree =
                regular
                    ? SliceTree(sliced(scene, set, group, hierarchy.order, queries), hierarchy, isa)
                    : SliceTree(sliced(scene, set, group, group.beams, queries), isa);
            std::vector<std::uint32_t> stack;
            SearchCounts counts;
            const Find find = [&](const Query& query, std::vector<BeamHit>& hits, SearchCounts& c) {
                ReceiverPoint point;
                point.position = query.point;
                tree.find(scene.sets, std::span(&point, 1), stack, std::span(&hits, 1), c);
            };
            expect_same(search(find, queries, counts), truth,
                        scene.name + ", two_slice, " + name(isa) + ", set " + std::to_string(set));
            EXPECT_EQ(tests.value_or(counts.cone_point_tests), counts.cone_point_tests);
            tests = counts.cone_point_tests;
        }
    }
}

// Every bound with both leaf tests, over one hierarchy and the other by turns: what a scan over all
// beams finds.
void expect_as_scan(const BeamScene& scene, int count) {
    for (std::uint32_t s = 0; s < scene.sets.size(); ++s) {
        const BeamSet& set = scene.sets[s];
        const auto& patches = scene.casters[0].mesh.patches;
        const std::vector<Query> queries = random_queries(scene, set, support::repetitions(count));
        const Points points(queries);
        std::vector<PlaneGroup> groups = fixed_planes(set);
        groups.push_back(receiver_planes(set)[0]);
        for (const PlaneGroup& group : groups) {
            const Found truth = scan(set, group, queries, points);
            EXPECT_GT(truth.size(), 0U);
            expect_whole(set, group, queries, truth);
            std::vector<Hierarchy> hierarchies = {binned_hierarchy(set, group.beams, 1)};
            if (!patches.empty()) hierarchies.push_back(quadtree(set, group.beams, patches));
            std::size_t turn = group.normal ? 0 : 1;
            for (const Bounds& bounds : all_bounds()) {
                const Hierarchy& hierarchy = hierarchies[turn++ % hierarchies.size()];
                const ConeTree tree(set, s, hierarchy, bounds.settings, group.normal);
                std::vector<std::uint32_t> stack;
                SearchCounts counts;
                const Find find = [&](const Query& query, std::vector<BeamHit>& hits,
                                      SearchCounts& c) {
                    tree.find(set, query.point, query.normal, stack, hits, c);
                };
                expect_same(search(find, queries, counts), truth,
                            scene.name + ", " + bounds.name + ", set " + std::to_string(s) +
                                (group.normal ? ", k" : ", n"));
            }
            if (group.normal) expect_slices_as_scan(scene, s, group, queries, truth);
        }
    }
}

// Together more than a million points for each bound and leaf test.
TEST(ConeTree, FindsTheBeamsOfAScanInAPool) { expect_as_scan({"pool", pool_desc(8)}, 130'000); }
TEST(ConeTree, FindsTheBeamsOfAScanInAPoolOfQuads) {
    expect_as_scan({"quads", pool_desc(8), PolygonKind::quad}, 30'000);
}
TEST(ConeTree, FindsTheBeamsOfAScanInARing) { expect_as_scan({"ring", ring_desc(4)}, 260'000); }
TEST(ConeTree, FindsTheBeamsOfAScanRoundABall) { expect_as_scan({"ball", ball_desc(8)}, 260'000); }
TEST(ConeTree, FindsTheBeamsOfAScanInASoup) { expect_as_scan({"soup", soup_desc(90)}, 130'000); }

}  // namespace
}  // namespace caustics::beamtree

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "beamtree/cone_tree.h"
#include "beamtree/plane_groups.h"
#include "core/sampling.h"
#include "tests/beamtree/beam_scenes.h"
#include "tests/support/sanitizers.h"

namespace caustics {
namespace {

/// Where a tree is asked.
struct Query {
    Vec3 point;
    Vec3 normal;
};

Vec3 random_direction(Rng& rng) { return uniform_cap(2, rng.next(), rng.next()).normalized(); }

// Half of the points anywhere round the scene, half inside a beam at any distance; planes of any
// tilt that face some beam.
std::vector<Query> random_queries(const BeamScene& scene, const BeamSet& set, int count) {
    std::vector<Query> queries;
    Rng rng(7, Stage::test, 0);
    for (int i = 0; i < count; ++i) {
        const Beam& beam = set.beams[rng.next_word() % set.beams.size()];
        const auto rays = set.triangle(beam, 0);
        const float u = std::sqrt(rng.next());
        const float v = rng.next();
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

using Found = std::vector<std::tuple<std::uint32_t, int, int>>;

Found sorted(const std::vector<BeamHit>& hits) {
    Found found;
    for (const BeamHit& hit : hits) found.emplace_back(hit.beam, hit.triangle, hit.winding);
    std::sort(found.begin(), found.end());
    return found;
}

Found scan(const BeamSet& set, const PlaneGroup& group, const Query& query) {
    const TestPlane plane(query.point, group.normal ? *group.normal : query.normal);
    std::vector<BeamHit> all;
    std::array<BeamHit, 2> hits;
    for (const std::uint32_t i : group.beams) {
        const int count = test_beam(set, set.beams[i], plane, hits);
        for (int k = 0; k < count; ++k) {
            all.push_back(hits[static_cast<std::size_t>(k)]);
            all.back().beam = i;
        }
    }
    return sorted(all);
}

struct Bounds {
    const char* name;
    ConeTreeSettings settings;
};

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

/// Counts queries whose tree answer differs from the scan's.
struct Differences {
    int missed = 0;
    int extra = 0;
    int hits = 0;
};

Differences compare(const BeamSet& set, const PlaneGroup& group, const ConeTree& tree,
                    const std::vector<Query>& queries, const std::vector<Found>& truth) {
    Differences differences;
    std::vector<std::uint32_t> stack;
    std::vector<BeamHit> hits;
    SearchCounts counts;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        hits.clear();
        tree.find(set, queries[i].point, queries[i].normal, stack, hits, counts);
        const Found found = sorted(hits);
        differences.missed +=
            !std::includes(found.begin(), found.end(), truth[i].begin(), truth[i].end());
        differences.extra +=
            !std::includes(truth[i].begin(), truth[i].end(), found.begin(), found.end());
        differences.hits += static_cast<int>(found.size());
    }
    EXPECT_LE(counts.beam_point_hits, counts.beam_point_tests);
    EXPECT_LE(counts.beam_point_tests, counts.cone_point_tests);
    EXPECT_LT(counts.beam_point_tests, queries.size() * group.beams.size());
    return differences;
}

// Every bound with both leaf tests, over one hierarchy and the other by turns: what a scan over all
// beams finds.
void expect_as_scan(const BeamScene& scene, int count) {
    for (std::uint32_t s = 0; s < scene.sets.size(); ++s) {
        const BeamSet& set = scene.sets[s];
        const auto& patches = scene.casters[0].mesh.patches;
        const std::vector<Query> queries = random_queries(scene, set, support::repetitions(count));
        std::vector<PlaneGroup> groups = fixed_planes(set);
        groups.push_back(receiver_planes(set)[0]);
        for (const PlaneGroup& group : groups) {
            std::vector<Found> truth;
            std::size_t all = 0;
            for (const Query& query : queries) {
                truth.push_back(scan(set, group, query));
                all += truth.back().size();
            }
            EXPECT_GT(all, 0U);
            std::vector<Hierarchy> hierarchies = {binned_hierarchy(set, group.beams, 1)};
            if (!patches.empty()) hierarchies.push_back(quadtree(set, group.beams, patches));
            std::size_t turn = group.normal ? 0 : 1;
            for (const Bounds& bounds : all_bounds()) {
                const Hierarchy& hierarchy = hierarchies[turn++ % hierarchies.size()];
                const ConeTree tree(set, s, hierarchy, bounds.settings, group.normal);
                const Differences d = compare(set, group, tree, queries, truth);
                EXPECT_EQ(d.missed, 0) << scene.name << ", " << bounds.name << ", set " << s
                                       << (group.normal ? ", k" : ", n");
                EXPECT_EQ(d.extra, 0);
            }
        }
    }
}

// Together more than a million points for each bound and leaf test.
TEST(ConeTree, FindsTheBeamsOfAScanInAPool) { expect_as_scan({"pool", pool_desc(8)}, 130'000); }
TEST(ConeTree, FindsTheBeamsOfAScanInARing) { expect_as_scan({"ring", ring_desc(4)}, 260'000); }
TEST(ConeTree, FindsTheBeamsOfAScanRoundABall) { expect_as_scan({"ball", ball_desc(8)}, 260'000); }
TEST(ConeTree, FindsTheBeamsOfAScanInASoup) { expect_as_scan({"soup", soup_desc(90)}, 130'000); }

}  // namespace
}  // namespace caustics

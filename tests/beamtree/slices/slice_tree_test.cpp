#include "beamtree/slices/slice_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "beamtree/beam_tree.h"
#include "beamtree/cones/plane_groups.h"
#include "beamtree/light/find_in_beam.h"
#include "beamtree/slices/slice_box.h"
#include "core/math/sampling.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

Box box_of(const Vec3& low, const Vec3& high) { return {low, high}; }

// Everything of one set, across +z.
SlicedBeams all_of(const std::vector<BeamSet>& sets, const Box& receivers) {
    SlicedBeams all{sets, {}, Vec3::UnitZ(), receivers};
    for (std::uint32_t i = 0; i < sets[0].beams.size(); ++i) all.beams.push_back({0, i});
    return all;
}

std::vector<std::uint32_t> found_in(const SliceTree& tree, const std::vector<BeamSet>& sets,
                                    const Vec3& point) {
    std::vector<std::uint32_t> stack;
    std::vector<BeamHit> hits[1];
    SearchCounts counts;
    ReceiverPoint receiver;
    receiver.position = point;
    tree.find(sets, std::span(&receiver, 1), stack, hits, counts);
    std::vector<std::uint32_t> beams;
    for (const BeamHit& hit : hits[0]) beams.push_back(hit.beam);
    std::sort(beams.begin(), beams.end());
    return beams;
}

std::vector<std::uint32_t> scanned(const BeamSet& set, const Vec3& point) {
    std::vector<std::uint32_t> beams;
    std::array<BeamHit, 2> hits;
    const TestPlane plane(point, Vec3::UnitZ());
    for (std::uint32_t i = 0; i < set.beams.size(); ++i)
        for (int n = test_beam(set, set.beams[i], plane, hits); n > 0; --n) beams.push_back(i);
    return beams;
}

/// Does the box hold what the beam holds? Hits and losses over planes of a tilt [rad].
struct Loss {
    int hits = 0;
    int lost = 0;
};

Loss loss_at(const BeamSet& set, const SliceFrame& frame, float tilt) {
    Loss loss;
    Rng rng(3, Stage::test, 0);
    for (const Beam& beam : set.beams) {
        SliceBox box;
        for (const VertexRay* ray : set.triangle(beam, 0)) box.extend(frame.slices(*ray));
        for (int i = 0; i < 300; ++i) {
            const auto height =
                frame.top() + static_cast<double>(rng.next()) * (frame.bottom() - frame.top());
            const float turn = 2 * pi * rng.next();
            const Vec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                              std::cos(tilt));
            const auto& ray = *set.triangle(beam, 0)[rng.next_word() % 3];
            const double down = (static_cast<double>(ray.position.z()) - height) /
                                -static_cast<double>(ray.direction.z());
            const Vec3 point = ray.position + static_cast<float>(down) * ray.direction +
                               0.04F * Vec3(rng.next() - 0.5F, rng.next() - 0.5F, 0);
            std::array<BeamHit, 2> hits;
            if (test_beam(set, beam, {point, normal}, hits) == 0) continue;
            ++loss.hits;
            const Vec2d at = frame.across(point.cast<double>());
            const auto t = static_cast<float>(frame.share(frame.height(point)));
            for (int axis = 0; axis < 2; ++axis) {
                const auto x = static_cast<float>(at[axis]);
                const float low = (1 - t) * box.low(axis, 0) + t * box.low(axis, 1);
                const float high = (1 - t) * box.high(axis, 0) + t * box.high(axis, 1);
                if (x >= low - 1e-6F && x <= high + 1e-6F) continue;
                ++loss.lost;
                break;
            }
        }
    }
    return loss;
}

// Why `leaf: n` is refused: boxes on two planes close to each other hold nothing on steep planes,
// whose caustic polygons reach out of the slab.
TEST(SliceBox, LosesHitsOfTiltedPlanesInAThinSlab) {
    const BeamScene pool("pool", pool_desc(16));
    const BeamSet& set = pool.sets[pool.sets[0].refracted ? 0 : 1];
    ASSERT_TRUE(set.refracted);
    const SliceFrame thin(Vec3::UnitZ(), -0.9, -1.1, Vec3::Zero());
    const Loss level = loss_at(set, thin, 0);
    EXPECT_GT(level.hits, 10'000);
    EXPECT_EQ(level.lost, 0);
    const Loss steep = loss_at(set, thin, 80 * pi / 180);
    EXPECT_GT(steep.hits, 10'000);
    EXPECT_GT(steep.lost, steep.hits / 1000);
    EXPECT_EQ(loss_at(set, {Vec3::UnitZ(), 0.1, -1.1, Vec3::Zero()}, 0).lost, 0);
}

BeamTreeParams params_of(Bound bound) {
    BeamTreeParams params;
    params.bound = bound;
    params.max_bounces = 1;
    if (bound != Bound::two_slice) return params;
    params.leaf = BeamTreeParams::Leaf::fixed;
    params.hierarchy = BeamTreeParams::Tree::binned;
    return params;
}

struct Answer {
    std::vector<float> irradiance;
    Counters counters;
};

// On the floor at z, and on a wall there.
Answer ask(const Scene& scene, const BeamTreeParams& params, const RunOptions& options, float z,
           int count) {
    const auto estimator = build(scene, params, options);
    const auto context = estimator->make_context();
    Rng rng(2, Stage::test, 0);
    Answer answer;
    for (int i = 0; i < count; ++i) {
        ReceiverPoint point{};
        point.position = Vec3(2 * rng.next() - 1, 2 * rng.next() - 1, z);
        point.geometric_normal = point.shading_normal = Vec3::UnitZ();
        Estimate estimate;
        estimator->irradiance(std::span(&point, 1), std::span(&estimate, 1), *context);
        answer.irradiance.push_back(estimate.value[1]);
    }
    context->add_to(answer.counters);
    return answer;
}

// Both leaf tests are one where the receiver lies across the fixed normal: the paper's tree and
// this one give the same light to the bit, on every instruction set.
TEST(SliceTree, GivesThePapersLightWhereTheNormalsAreOne) {
    SceneDesc desc = pool_desc(24);
    desc.lights.push_back(support::point_light({-0.7, 0.2, 1.9}, 6));
    const Scene scene(std::move(desc));
    const Answer paper = ask(scene, params_of(Bound::hybrid), {}, -1, 4000);
    std::optional<Answer> first;
    for (const Isa isa : supported_isas()) {
        RunOptions options;
        options.isa = isa;
        const Answer slices = ask(scene, params_of(Bound::two_slice), options, -1, 4000);
        EXPECT_EQ(slices.irradiance, paper.irradiance);
        EXPECT_EQ(slices.counters.at("beam_point_hits"), paper.counters.at("beam_point_hits"));
        if (first) {
            EXPECT_EQ(slices.counters, first->counters);
        }
        first = slices;
    }
    EXPECT_GT(std::accumulate(paper.irradiance.begin(), paper.irradiance.end(), 0.0F), 100);
    EXPECT_LT(first->counters.at("cone_point_tests"), paper.counters.at("cone_point_tests"));
    EXPECT_LT(2 * first->counters.at("beam_point_tests"), paper.counters.at("beam_point_tests"));
}

// High waves send light sideways to other waves. Its beams begin at all depths along their tree's
// axis, and those that begin below a point are left out: exact tests would be dozens a hit.
TEST(SliceTree, LeavesOutBeamsThatBeginBelowThePoint) {
    SineHeightfield high = waves();
    for (SineWave& wave : high.waves) wave.amplitude *= 3;
    SceneDesc desc = pool_desc(1);
    desc.shapes[0] = support::mesh("water", tessellate_heightfield(high, 48), Transform::Identity(),
                                   support::glass(1.333F));
    const Scene scene(std::move(desc));
    BeamTreeParams params = params_of(Bound::two_slice);
    params.max_bounces = 16;
    const Answer slices = ask(scene, params, {}, -1, 2000);
    const auto hits = slices.counters.at("beam_point_hits");
    EXPECT_LT(slices.counters.at("beam_point_tests"), 6 * hits);
    params.bound = Bound::sphere_swept;
    params.leaf = BeamTreeParams::Leaf::fixed;
    EXPECT_EQ(slices.irradiance, ask(scene, params, {}, -1, 2000).irradiance);
}

// Lights share a tree, unless it follows the quadtree of the mesh.
TEST(SliceTree, HoldsTheBeamsOfAllLights) {
    SceneDesc desc = pool_desc(8);
    desc.lights.clear();
    for (const double x : {-0.3, -0.1, 0.2, 0.3})
        desc.lights.push_back(support::point_light({x, 0.2, 6}, 60));
    const Scene scene(std::move(desc));
    BeamTreeParams params = params_of(Bound::two_slice);
    const auto trees = [&] {
        return build(scene, params, {})->build_report().counters.at("trees");
    };
    EXPECT_EQ(trees(), 1U);  // what the water reflects meets no receiver
    const Answer binned = ask(scene, params, {}, -0.6F, 500);
    params.hierarchy = BeamTreeParams::Tree::quadtree;
    EXPECT_EQ(trees(), 4U);
    const Answer regular = ask(scene, params, {}, -0.6F, 500);
    EXPECT_EQ(binned.irradiance, regular.irradiance);
}

// The points of a picture's tile, row by row and at many heights, asked about together.
TEST(SliceTree, AnswersABatchAsEachPointAlone) {
    for (const bool ring : {false, true}) {
        const Scene scene(ring ? ring_desc(24) : pool_desc(24));
        const auto estimator = build(scene, params_of(Bound::two_slice), {});
        std::vector<ReceiverPoint> points;
        Rng rng(4, Stage::test, 0);
        for (int i = 0; i < 3000; ++i) {
            ReceiverPoint point{};
            const float step = i < 2000 ? 0.003F : 0.05F;
            const Vec3 at(static_cast<float>(i % 16), static_cast<float>(i / 16 % 16), 0);
            point.position = step * at + Vec3(-0.1F, -0.3F, ring ? 0.0F : -1.0F);
            if (i % 64 > 50) point.position.z() += 0.001F * static_cast<float>(i % 60);
            point.geometric_normal = Vec3(rng.next() - 0.5F, rng.next() - 0.5F, 1).normalized();
            points.push_back(point);
        }
        const auto batch = estimator->make_context();
        const auto single = estimator->make_context();
        std::vector<Estimate> together(points.size());
        std::vector<Estimate> alone(points.size());
        estimator->irradiance(points, together, *batch);
        int lit = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            estimator->irradiance(std::span(&points[i], 1), std::span(&alone[i], 1), *single);
            EXPECT_TRUE((together[i].value == alone[i].value).all());
            lit += is_black(alone[i].value) ? 0 : 1;
        }
        EXPECT_GT(lit, 500);
        Counters of_batch;
        Counters of_single;
        batch->add_to(of_batch);
        single->add_to(of_single);
        EXPECT_EQ(of_batch.at("beam_point_hits"), of_single.at("beam_point_hits"));
        EXPECT_LT(of_batch.at("cone_point_tests"), of_single.at("cone_point_tests"));
    }
}

// Rays of a grid of triangles that all meet in one point, and part again.
BeamSet lens(int cells, const Vec3& focus, const Vec3& shift) {
    BeamSet set;
    const auto n = static_cast<std::uint32_t>(cells);
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) {
            const Vec3 from = shift + Vec3(static_cast<float>(i), static_cast<float>(j), 0) /
                                          static_cast<float>(cells);
            set.rays.push_back({from, (focus + shift - from).normalized()});
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j;
            Beam beam;
            beam.corners = {a, a + 1, a + n + 2, Beam::none};
            set.beams.push_back(beam);
            beam.corners = {a, a + n + 2, a + n + 1, Beam::none};
            set.beams.push_back(beam);
        }
    return set;
}

void expect_as_scan(const std::vector<BeamSet>& sets, const Box& where, int count,
                    Isa isa = widest_isa()) {
    Rng rng(9, Stage::test, 0);
    const SliceTree tree(all_of(sets, where), isa);
    std::size_t hits = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 share(rng.next(), rng.next(), rng.next());
        const Vec3 point = where.min() + share.cwiseProduct(where.diagonal());
        const auto truth = scanned(sets[0], point);
        EXPECT_EQ(found_in(tree, sets, point), truth);
        hits += truth.size();
    }
    EXPECT_GT(hits, 0U);
}

TEST(SliceTree, FollowsBeamsThroughAFocus) {
    const Vec3 focus(0.5F, 0.5F, -1);
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(4000, -9000, 700)}) {
        const std::vector<BeamSet> sets = {lens(9, focus, shift)};
        const Box where = box_of(shift + Vec3(0, 0, -2), shift + Vec3(1, 1, 0));
        expect_as_scan(sets, where, 3000);
        // All beams meet here.
        const SliceTree tree(all_of(sets, where), widest_isa());
        const Vec3 at = shift + focus + Vec3(1e-3F, 2e-3F, 0);
        EXPECT_EQ(found_in(tree, sets, at), scanned(sets[0], at));
    }
}

// Triangles are cut at points between their rays' starts. Where rays go apart, what is left reaches out of the triangle
// of the whole rays: a box holds it.
TEST(SliceTree, FollowsBeamsWhoseRaysBeginAtAllDepths) {
    std::vector<BeamSet> sets = {lens(3, {0.5F, 0.5F, -1}, Vec3::Zero())};
    Rng rng(6, Stage::test, 0);
    for (VertexRay& ray : sets[0].rays) {
        ray.direction = Vec3(rng.next() - 0.5F, rng.next() - 0.5F, -1).normalized();
        ray.position += 1.5F * rng.next() * ray.direction;
    }
    for (const Isa isa : supported_isas())
        expect_as_scan(sets, box_of({-0.5F, -0.5F, -2}, {1.5F, 1.5F, 0}), 10'000, isa);
}

TEST(SliceTree, TakesBeamsThatCannotBeParted) {
    for (const int count : {1, 2, 7, 8, 9, 100}) {
        std::vector<BeamSet> sets = {lens(1, {0.5F, 0.5F, -1}, Vec3::Zero())};
        sets[0].beams.resize(1);
        sets[0].beams.resize(static_cast<std::size_t>(count), sets[0].beams[0]);
        const SliceTree tree(all_of(sets, box_of({0, 0, -3}, {1, 1, 0})), widest_isa());
        EXPECT_EQ(found_in(tree, sets, {0.3F, 0.6F, -0.5F}).size(),
                  static_cast<std::size_t>(count));
        EXPECT_TRUE(found_in(tree, sets, {2, 2, -0.5F}).empty());
    }
}

TEST(SliceTree, TellsItsMemory) {
    // One leaf; two, and the node above them.
    for (const std::size_t count : {8U, 9U}) {
        std::vector<BeamSet> sets = {lens(1, {0.5F, 0.5F, -1}, Vec3::Zero())};
        sets[0].beams.resize(1);
        sets[0].beams.resize(count, sets[0].beams[0]);
        const SliceTree tree(all_of(sets, box_of({0, 0, -3}, {1, 1, 0})), widest_isa());
        EXPECT_EQ(tree.node_count(), count == 8 ? 1U : 3U);
        const std::size_t of_beams = count * (sizeof(BeamNumber) + 3 * sizeof(VertexRay));
        const std::size_t of_nodes =
            count == 8 ? sizeof(SliceLeaf) : 2 * sizeof(SliceLeaf) + sizeof(SliceNode);
        EXPECT_EQ(tree.bytes(), of_beams + of_nodes);
    }
}

// Rays of a grid of triangles from a square of one half side to one of another, 1 m below.
BeamSet between_squares(std::uint32_t cells, float above, float below) {
    BeamSet set;
    for (std::uint32_t i = 0; i <= cells; ++i)
        for (std::uint32_t j = 0; j <= cells; ++j) {
            const Vec3 from = above * Vec3(static_cast<float>(i), static_cast<float>(j), 0);
            const Vec3 to =
                below * Vec3(static_cast<float>(i), static_cast<float>(j), 0) - Vec3::UnitZ();
            set.rays.push_back({from, (to - from).normalized()});
        }
    for (std::uint32_t i = 0; i < cells; ++i)
        for (std::uint32_t j = 0; j < cells; ++j) {
            const std::uint32_t a = i * (cells + 1) + j;
            Beam beam;
            beam.corners = {a, a + cells + 1, a + cells + 2, Beam::none};
            set.beams.push_back(beam);
            beam.corners = {a, a + cells + 2, a + 1, Beam::none};
            set.beams.push_back(beam);
        }
    return set;
}

// Beams may be as narrow as rounding on either plane, and far apart: on the edges that two of them share a point is found as a
// scan finds it.
TEST(SliceTree, FindsWhatIsOnEdgesWhereBeamsAreNarrow) {
    for (const auto& [above, below] : {std::pair(1.0F, 1.0F),
                                       {1.0F, 1e-5F},
                                       {1e-5F, 1.0F},
                                       {300.0F, 300.0F},
                                       {300.0F, 1e-3F},
                                       {1e-3F, 300.0F}}) {
        const std::vector<BeamSet> sets = {between_squares(6, above, below)};
        const SliceTree tree(all_of(sets, box_of({0, 0, -1}, {0, 0, 0})), widest_isa());
        Rng rng(11, Stage::test, 0);
        std::size_t hits = 0;
        for (int i = 0; i < 4000; ++i) {
            const float depth = 0.02F + 0.96F * rng.next();
            const float along = i % 5 == 0 ? 0 : rng.next();
            const auto rays = sets[0].triangle(sets[0].beams[rng.next_word() % 72], 0);
            const auto at = [&](const VertexRay& ray) {
                return Vec3(ray.position + depth / -ray.direction.z() * ray.direction);
            };
            const Vec3 point = (1 - along) * at(*rays[0]) + along * at(*rays[1]);
            const auto truth = scanned(sets[0], point);
            EXPECT_EQ(found_in(tree, sets, point), truth) << above << " to " << below;
            hits += truth.size();
        }
        EXPECT_GT(hits, 3000U);
    }
}

/// How rays move with the wavelength.
struct Drift {
    Vec2 start;          ///< of their starts, to either side
    bool meets = false;  ///< all wavelengths come together below
    float begins = 0;    ///< rays begin at all heights down to there, and go apart
};

std::vector<BeamSet> drifting_beams(const Vec2& size, const Drift& drift) {
    std::vector<BeamSet> sets = {between_squares(4, 1, 1)};
    BeamSet& set = sets[0];
    set.light.drifts = true;
    Rng rng(8, Stage::test, 0);
    const auto either = [&rng] { return rng.next_word() % 2 == 0 ? 1.0F : -1.0F; };
    for (VertexRay& ray : set.rays) {
        ray.position = Vec3(size.x() * ray.position.x(), size.y() * ray.position.y(), 0);
        if (drift.begins > 0) {
            ray.position.z() -= drift.begins * rng.next();
            ray.direction = Vec3(0.5F * either() * size.x(), 0.5F * either() * size.y(), -1);
            ray.direction.normalize();
        }
        const Vec3 by(either() * drift.start.x(), either() * drift.start.y(), 0);
        const Vec3 foot =
            ray.position + (1 + ray.position.z()) / -ray.direction.z() * ray.direction;
        for (const std::size_t end : {0U, 1U}) {
            const Vec3 from = ray.position + (end == 0 ? -by : by);
            set.ends[end].push_back(
                {from, drift.meets ? Vec3((foot - from).normalized()) : ray.direction});
        }
    }
    return sets;
}

std::vector<std::uint32_t> scanned_drifting(const BeamSet& set, const Vec3& point) {
    std::vector<BeamHit> hits;
    SearchCounts counts;
    for (std::uint32_t beam = 0; beam < set.beams.size(); ++beam)
        find_in_beam(set, {0, beam}, {point, Vec3::UnitZ()}, hits, counts);
    std::vector<std::uint32_t> beams;
    for (const BeamHit& hit : hits) beams.push_back(hit.beam);
    std::ranges::sort(beams);
    return beams;
}

// A triangle of a leaf must allow for all that its corners move, also where it is cut.
TEST(SliceTree, FollowsBeamsThatDrift) {
    for (const Vec2& size : {Vec2(1, 1), Vec2(20, 0.5F), Vec2(0.5F, 20)})
        for (const Drift& shares :
             {Drift{{0.2F, 0.2F}}, Drift{{0.4F, 0}}, Drift{{0, 0.4F}}, Drift{{0.4F, 0}, true},
              Drift{{0, 0.4F}, true}, Drift{{0.2F, 0.2F}, false, 0.8F},
              Drift{{0.4F, 0}, false, 0.8F}, Drift{{0, 0.4F}, false, 0.8F}}) {
            Drift drift = shares;
            drift.start = drift.start.cwiseProduct(size);
            const std::vector<BeamSet> sets = drifting_beams(size, drift);
            const BeamSet& set = sets[0];
            const SliceTree tree(all_of(sets, box_of({0, 0, -1}, {0, 0, 0})), widest_isa());
            Rng rng(12, Stage::test, 0);
            std::size_t hits = 0;
            for (int i = 0; i < 2000; ++i) {
                // Near an edge of a triangle at one end of the bin.
                const auto rays = set.triangle(set.beams[rng.next_word() % set.beams.size()], 0,
                                               i % 2 == 0 ? 1 : -1);
                const float inwards = 0.05F * rng.next();
                const float along = (1 - inwards) * rng.next();
                Vec3 from = Vec3::Zero();
                Vec3 way = Vec3::Zero();
                for (const auto& [weight, ray] : {std::pair(1 - along - inwards, rays[0]),
                                                  {along, rays[1]},
                                                  {inwards, rays[2]}}) {
                    from += weight * ray.position;
                    way += weight * ray.direction;
                }
                const float depth = -from.z() + (0.95F + from.z()) * rng.next();
                const Vec3 point = from + (from.z() + depth) / -way.z() * way;
                const auto truth = scanned_drifting(set, point);
                EXPECT_EQ(found_in(tree, sets, point), truth)
                    << size.transpose() << ", " << shares.start.transpose() << ", " << drift.meets
                    << drift.begins << ": " << point.transpose();
                hits += truth.size();
            }
            EXPECT_GT(hits, 500U);
        }
}

/// Sixteen times the same beam: two leaves, and the node above them. The triangle at the top shrinks by a factor on its way
/// down, and moves along x.
std::vector<BeamSet> one_beam_often(const Vec2& size, float shrinks, float moves) {
    std::vector<BeamSet> sets(1);
    for (const Vec2& at : {Vec2(0, 0), Vec2(size.x(), 0), Vec2(0, size.y())}) {
        const Vec3 from(at.x(), at.y(), 0);
        const Vec3 to(shrinks * at.x() + moves, shrinks * at.y(), -1);
        sets[0].rays.push_back({from, (to - from).normalized()});
    }
    Beam beam;
    beam.corners = {0, 1, 2, Beam::none};
    sets[0].beams.resize(16, beam);
    return sets;
}

// How often the tree of one_beam_often is walked through for two points inside.
std::uint64_t walks_for(const std::vector<BeamSet>& sets, const Vec3& a, const Vec3& b) {
    const SliceTree tree(all_of(sets, box_of({0, 0, -1}, {1, 1, 0})), widest_isa());
    EXPECT_EQ(tree.node_count(), 3U);
    std::array<ReceiverPoint, 2> points;
    points[0].position = a;
    points[1].position = b;
    std::vector<std::uint32_t> stack;
    std::array<std::vector<BeamHit>, 2> hits;
    SearchCounts counts;
    tree.find(sets, points, stack, hits, counts);
    // Each point is tested against sixteen triangles, each walk against the boxes of two leaves.
    return (counts.cone_point_tests - 2 * 16) / 2;
}

// Mean over both planes: a half and a whole of the longer side make up three quarters.
TEST(SliceTree, WalksOnceForPointsWithinHalfALeafOfEachOther) {
    for (const Vec2& size : {Vec2(1, 0.7F), Vec2(0.7F, 1)}) {
        const std::vector<BeamSet> sets = one_beam_often(size, 0.5F, 0);
        const float half_leaf = 0.75F / 2;
        const Vec3 a(0.05F, 0.05F, -0.1F);
        for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
            EXPECT_EQ(walks_for(sets, a, a + 0.95F * half_leaf * axis), 1U);
            EXPECT_EQ(walks_for(sets, a, a + 1.05F * half_leaf * axis), 2U);
        }
        // Rays that stay where they are may be asked about at all heights together.
        EXPECT_EQ(walks_for(sets, a, a - 0.8F * Vec3::UnitZ()), 1U);
    }
    // And no more down than rays move by that.
    const float moves = 2;
    const std::vector<BeamSet> sets = one_beam_often({1, 0.7F}, 0.5F, moves);
    const float most = 0.75F / 2 / moves;
    const Vec3 a(1, 0.05F, -0.2F);
    EXPECT_EQ(walks_for(sets, a, a - 0.95F * most * Vec3::UnitZ()), 1U);
    EXPECT_EQ(walks_for(sets, a, a - 1.05F * most * Vec3::UnitZ()), 2U);
}

// Sixty-four leaves of eight triangles: eight nodes of eight, and the root.
TEST(SliceTree, IsEightWideWhereItsHierarchyIsEven) {
    const std::vector<BeamSet> sets = {lens(16, {0.5F, 0.5F, -1}, Vec3::Zero())};
    Hierarchy halves;
    halves.order.resize(512);
    std::iota(halves.order.begin(), halves.order.end(), 0U);
    halves.nodes.push_back({0, 512, 0, 0});
    for (std::uint32_t i = 0; i < halves.nodes.size(); ++i) {
        Hierarchy::Node& node = halves.nodes[i];
        if (node.beam_count == 1) continue;
        const std::uint32_t first = node.first_beam, half = node.beam_count / 2;
        node.first_child = static_cast<std::uint32_t>(halves.nodes.size());
        node.child_count = 2;
        halves.nodes.push_back({first, half, 0, 0});
        halves.nodes.push_back({first + half, half, 0, 0});
    }
    const SliceTree tree(all_of(sets, box_of({0, 0, -2}, {1, 1, 0})), halves, widest_isa());
    EXPECT_EQ(tree.node_count(), 1U + 8U + 64U);
    EXPECT_EQ(tree.height(), 3U);
}

TEST(SliceTree, RefusesPointsBelowItsSlab) {
    const std::vector<BeamSet> sets = {lens(3, {0.5F, 0.5F, -1}, Vec3::Zero())};
    const SliceTree tree(all_of(sets, box_of({0, 0, -2}, {1, 1, 0})), widest_isa());
    EXPECT_TRUE(found_in(tree, sets, {0.5F, 0.5F, 0.1F}).empty());  // above all polygons
    EXPECT_THROW(found_in(tree, sets, {0.5F, 0.5F, -2.1F}), std::out_of_range);
}

}  // namespace
}  // namespace caustics::beamtree

#include "photonmap/tree/build_tree.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "photon_sets.h"
#include "photonmap/tree/balanced_kd_tree.h"

namespace caustics::photonmap {
namespace {

using test::Found;
using test::linear_scan;
using test::photon_at;
using test::photon_sets;
using test::store_of;

constexpr TreeKind kinds[] = {TreeKind::balanced, TreeKind::unbalanced, TreeKind::packed};

struct NamedTree {
    std::string name;
    std::unique_ptr<const PhotonTree> tree;
};

/// Every kind on every instruction set.
std::vector<NamedTree> all_trees(std::span<const Photon> photons) {
    std::vector<NamedTree> trees;
    for (const TreeKind kind : kinds)
        for (const Isa isa : supported_isas())
            trees.push_back({std::string(name(kind)) + " " + name(isa),
                             build_tree(kind, store_of(photons), isa)});
    return trees;
}

ReceiverPoint point_at(const Vec3& x, const Vec3& normal) {
    ReceiverPoint point;
    point.position = x;
    point.geometric_normal = point.shading_normal = point.wo = normal;
    point.uv = Vec2::Zero();
    return point;
}

/// Points near the photons and exactly at photons, side by side as in a tile: `spacing` is in parts of
/// the photons' extent.
std::vector<ReceiverPoint> query_points(std::span<const Photon> photons, std::size_t count,
                                        float spacing, const Vec3& normal, std::uint64_t seed) {
    Rng rng(seed, Stage::test, photons.size());
    if (photons.empty()) return {point_at({1, 2, 3}, normal)};
    const auto any = [&] { return position(photons[rng.next_word() % photons.size()]); };
    const Vec3 first = any();
    const Vec3 step = spacing * (any() - first), other = spacing * (any() - first);
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 at =
            first + static_cast<float>(i % 4) * step + static_cast<float>(i / 4) * other;
        points.push_back(point_at(i % 5 == 4 && spacing > 0.1F ? any() : at, normal));
    }
    return points;
}

/// The position must be at the distance.
void expect_position(const ReceiverPoint& point, const GatheredPhotons& gathered, std::size_t k) {
    Photon photon{};
    for (int axis = 0; axis < 3; ++axis) photon.position[axis] = gathered.position[axis][k];
    EXPECT_EQ(test::squared_distance(photon, point.position), gathered.squared_distance[k]);
}

std::vector<std::vector<Found>> answers(const PhotonTree& tree,
                                        std::span<const ReceiverPoint> points,
                                        const GatherLimits& limits, GatherScratch& scratch) {
    std::vector<std::vector<Found>> all(points.size());
    std::vector<int> times(points.size());
    tree.gather(points, limits, scratch, [&](std::size_t i, const GatheredPhotons& gathered) {
        ++times[i];
        for (std::size_t k = 0; k < gathered.count; ++k) {
            all[i].push_back(
                {gathered.squared_distance[k], gathered.energy[k], gathered.direction[k]});
            if (limits.positions) expect_position(points[i], gathered, k);
        }
        if (!all[i].empty()) {
            const Found farthest = all[i][gathered.farthest];
            std::ranges::sort(all[i]);
            const bool around = limits.margin > 0 && limits.nearest != GatherLimits::all;
            if (gathered.full || !around) {
                // With a margin the last of those at the N-th distance.
                const std::size_t rank = gathered.full ? limits.nearest : all[i].size();
                const auto beyond = std::ranges::upper_bound(
                    all[i], all[i][rank - 1].squared_distance, {}, &Found::squared_distance);
                EXPECT_EQ(farthest, *std::prev(beyond));
            }
        }
    });
    EXPECT_EQ(times, std::vector<int>(points.size(), 1));
    return all;
}

/// Batches of wide and of close points must give what a linear scan gives, in every tree.
void expect_same_as_scan(std::span<const Photon> photons, const std::vector<NamedTree>& trees,
                         std::size_t nearest, const Vec3& normal, std::uint64_t seed) {
    Rng rng(seed, Stage::test, nearest);
    GatherScratch scratch;
    for (const float spacing : {1.0F, 0.05F, 1e-3F, 0.0F}) {
        const auto points = query_points(photons, 18, spacing, normal, seed);
        GatherLimits limits{.nearest = nearest, .max_radius = 1e18F, .positions = nearest % 2 == 0};
        if (spacing > 1e-3F && !photons.empty()) {
            // A radius among the photons' distances.
            const Photon& any = photons[rng.next_word() % photons.size()];
            limits.max_radius = std::max(1e-12F, (position(any) - points[0].position).norm());
        }
        if (spacing == 0.05F && !photons.empty() && nearest > 1)
            limits.margin = 0.3F * std::min(limits.max_radius, 1e9F) * rng.next();
        std::vector<std::vector<Found>> expected;
        for (const ReceiverPoint& point : points)
            expected.push_back(linear_scan(photons, point, limits));
        for (const NamedTree& tree : trees)
            ASSERT_EQ(answers(*tree.tree, points, limits, scratch), expected)
                << tree.name << ", spacing " << spacing << ", radius " << limits.max_radius;
    }
}

TEST(PhotonTree, FindsTheSamePhotonsAsALinearScan) {
    for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 7U, 8U, 63U, 64U, 65U, 100U, 3'001U}) {
        for (const auto& set : photon_sets(count, 15)) {
            const auto trees = all_trees(set.photons);
            for (const std::size_t nearest :
                 {std::size_t{1}, std::size_t{2}, std::size_t{50}, GatherLimits::all}) {
                SCOPED_TRACE(set.name + ", " + std::to_string(nearest) + " of " +
                             std::to_string(count));
                expect_same_as_scan(set.photons, trees, nearest, Vec3::UnitZ(), 16);
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

TEST(PhotonTree, ManySmallRandomSets) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Rng rng(seed, Stage::test, 0);
        const std::size_t count = rng.next_word() % 200;
        const std::size_t nearest = 1 + rng.next_word() % 60;
        const float x = rng.next() - 0.5F, y = rng.next() - 0.5F, z = rng.next() - 0.5F;
        const Vec3 normal = Vec3(x, y, z).normalized();
        for (const auto& set : photon_sets(count, 100 + seed)) {
            SCOPED_TRACE(set.name + ", " + std::to_string(nearest) + " of " +
                         std::to_string(count) + ", seed " + std::to_string(seed));
            expect_same_as_scan(set.photons, all_trees(set.photons), nearest, normal, seed);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(PhotonTree, NeedsNoSideTestWhereAllPhotonsComeFromAbove) {
    for (auto& set : photon_sets(3'000, 17)) {
        for (Photon& photon : set.photons) photon.theta /= 4;
        const auto trees = all_trees(set.photons);
        for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0.6F, 0.8F), Vec3(1, 0, 0)}) {
            SCOPED_TRACE(set.name);
            expect_same_as_scan(set.photons, trees, 20, normal, 18);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(PhotonTree, LeavesOutPhotonsOfSurfacesThatFaceElsewhere) {
    const Vec3 normals[] = {{0, 0, 1}, {0.6F, 0, 0.8F}, {1, 0, 0}, {0, -1, 0}};
    for (auto& set : photon_sets(2'000, 23)) {
        for (std::size_t i = 0; i < set.photons.size(); ++i) {
            const Vec3& n = normals[i / 7 % 4];
            set.photons[i].flags = facing_flags({n.x(), n.y(), n.z()});
            set.photons[i].theta /= 3;
        }
        const auto trees = all_trees(set.photons);
        for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0.6F, 0.8F), Vec3(-1, 0, 0)}) {
            SCOPED_TRACE(set.name);
            expect_same_as_scan(set.photons, trees, 20, normal, 24);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(PhotonTree, KeepsWhereSurfacesFace) {
    for (auto& set : photon_sets(5'000, 25)) {
        Rng rng(26, Stage::test, 0);
        for (Photon& photon : set.photons)
            photon.flags = static_cast<std::uint16_t>(rng.next_word() & facing_mask);
        balance(set.photons);
        std::vector<unsigned> kept, given;
        Rng again(26, Stage::test, 0);
        for (const Photon& photon : set.photons) {
            ASSERT_LE(photon.flags & ~facing_mask, 2U);
            kept.push_back(photon.flags & facing_mask);
            given.push_back(again.next_word() & facing_mask);
        }
        std::ranges::sort(kept);
        std::ranges::sort(given);
        EXPECT_EQ(kept, given) << set.name;
    }
}

/// Photons as below a ball: most in one small spot, the rest far around it.
std::vector<Photon> spot(std::size_t count) {
    Rng rng(19, Stage::test, 0);
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < count; ++i) {
        const float angle = 2 * pi * rng.next(), u = rng.next();
        const float radius = i % 10 == 0 ? u : 0.01F * u * u;
        photons.push_back(photon_at({radius * std::cos(angle), radius * std::sin(angle), 0}));
        photons.back().phi = static_cast<std::uint8_t>(rng.next_word());
        photons.back().theta = static_cast<std::uint8_t>(rng.next_word() % 100);
    }
    return photons;
}

/// Photons as below waves: folds all over the floor.
std::vector<Photon> folds(std::size_t count) {
    Rng rng(20, Stage::test, 0);
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = rng.next(), y = rng.next();
        photons.push_back(photon_at({x + 0.05F * std::sin(40 * x + 17 * y),
                                     y + 0.04F * std::sin(29 * y - 31 * x), 1e-7F * x}));
    }
    return photons;
}

/// A picture's tile of 16 x 16 points, row by row.
std::vector<ReceiverPoint> tile(const Vec3& corner, float spacing) {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 256; ++i)
        points.push_back(point_at(
            corner + spacing * Vec3(static_cast<float>(i % 16), static_cast<float>(i / 16), 0),
            Vec3::UnitZ()));
    return points;
}

/// Every fifth point must get what a linear scan gives.
void expect_scan_at_some(std::span<const Photon> photons, const std::vector<NamedTree>& trees,
                         std::span<const ReceiverPoint> points, const GatherLimits& limits) {
    std::vector<std::vector<Found>> expected;
    for (std::size_t i = 0; i < points.size(); i += 5)
        expected.push_back(linear_scan(photons, points[i], limits));
    for (const NamedTree& tree : trees) {
        GatherScratch scratch;
        const auto found = answers(*tree.tree, points, limits, scratch);
        for (std::size_t i = 0; i < points.size(); i += 5)
            ASSERT_EQ(found[i], expected[i / 5]) << tree.name << " " << i;
    }
}

TEST(PhotonTree, TilesOverCausticsGetWhatALinearScanGets) {
    for (const auto& photons : {spot(30'000), folds(30'000)}) {
        const auto trees = all_trees(photons);
        for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.2F, 0.3F, 0), Vec3(-0.02F, 0.005F, 0)}) {
            for (const float spacing : {2e-4F, 2e-3F, 2e-2F}) {
                const auto points = tile(corner, spacing);
                // The 60 nearest, or all within a radius.
                const GatherLimits limits = spacing == 2e-3F
                                                ? GatherLimits{GatherLimits::all, 0.01F}
                                                : GatherLimits{60, 0.05F, true};
                expect_scan_at_some(photons, trees, points, limits);
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

// Most searches meet no photon that lies behind; the others must leave it out, whichever way the
// points of a tile look.
TEST(PhotonTree, LeavesThePhotonsBehindOutOfTiles) {
    std::vector<Photon> photons = spot(10'000);
    for (std::size_t i = 0; i < photons.size(); i += 300) photons[i].theta = 200;
    const auto trees = all_trees(photons);
    for (const float tilt : {0.0F, 0.1F, 0.6F}) {
        for (const float spacing : {2e-4F, 4e-3F}) {
            auto points = tile({0, 0, 0}, spacing);
            for (std::size_t i = 0; i < points.size(); i += 3)
                points[i].geometric_normal = Vec3(tilt, 0, 1).normalized();
            expect_scan_at_some(photons, trees, points, {40, 0.05F});
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

// Those up to a margin beyond the N-th, or beyond the largest radius where there are fewer.
TEST(PhotonTree, TilesGetAllPhotonsOfAMargin) {
    std::vector<Photon> behind = spot(4'000);
    for (std::size_t i = 0; i < behind.size(); i += 300) behind[i].theta = 200;
    for (const auto& photons : {spot(4'000), folds(4'000), behind}) {
        const auto trees = all_trees(photons);
        for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.2F, 0.3F, 0)})
            for (const float spacing : {2e-4F, 2e-3F, 2e-2F})
                for (const std::size_t nearest :
                     {std::size_t{2}, std::size_t{60}, GatherLimits::all}) {
                    const GatherLimits limits{nearest, 0.01F, true, 0.7F * spacing};
                    expect_scan_at_some(photons, trees, tile(corner, spacing), limits);
                    if (testing::Test::HasFatalFailure()) return;
                }
    }
}

TEST(PhotonTree, PackedAnswersATileInGroupsWhereItIsNarrow) {
    const auto tree = build_tree(TreeKind::packed, store_of(folds(30'000)), widest_isa());
    GatherScratch scratch;
    const GatherLimits limits{.nearest = 60, .max_radius = 0.05F};
    answers(*tree, tile({0.5F, 0.5F, 0}, 1e-3F), limits, scratch);
    EXPECT_GT(scratch.grouped_queries, 200U);
    scratch.grouped_queries = 0;
    answers(*tree, tile({0.1F, 0.1F, 0}, 0.05F), limits, scratch);
    EXPECT_EQ(scratch.grouped_queries, 0U);
}

TEST(PhotonTree, AnswersAlikeHoweverManyThreadsMadeIt) {
    const std::vector<Photon> photons = folds(300'001);
    const GatherLimits limits{.nearest = 60, .max_radius = 0.05F};
    const std::vector<ReceiverPoint> points = tile({0.5F, 0.5F, 0}, 1e-2F);
    for (const TreeKind kind : {TreeKind::packed, TreeKind::balanced}) {
        GatherScratch scratch;
        const auto one =
            answers(*build_tree(kind, store_of(photons), widest_isa()), points, limits, scratch);
        for (const int threads : {2, 3, 8})
            EXPECT_EQ(answers(*build_tree(kind, store_of(photons), widest_isa(), threads), points,
                              limits, scratch),
                      one)
                << threads;
    }
}

TEST(PhotonTree, HoldsAsManyBytesAsItSays) {
    const std::vector<Photon> photons = folds(100'000);
    const auto per_photon = [&](TreeKind kind) {
        const auto tree = build_tree(kind, store_of(photons), widest_isa());
        EXPECT_EQ(tree->size(), photons.size());
        return static_cast<double>(tree->bytes()) / 100'000;
    };
    EXPECT_EQ(per_photon(TreeKind::balanced), 20);
    EXPECT_EQ(per_photon(TreeKind::unbalanced), 28);
    EXPECT_GT(per_photon(TreeKind::packed), 20);
    EXPECT_LE(per_photon(TreeKind::packed), 20.2);
}

std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(PhotonTree, IsBuiltInThePhotonsOwnMemory) {
    constexpr std::size_t count = 1'500'000;
    for (const TreeKind kind : {TreeKind::balanced, TreeKind::packed}) {
        // A first build loads the code and starts the threads, which hold memory too.
        build_tree(kind, store_of(folds(count / 10)), widest_isa());
        PhotonStore store = store_of(folds(count));
        const std::size_t before = resident_bytes();
        const auto tree = build_tree(kind, std::move(store), widest_isa());
        const std::size_t after = resident_bytes();
        EXPECT_LE(after, before + (1U << 20U)) << name(kind);
    }
}

/// Photons on a line, in order along it: the unbalanced tree is a list.
std::vector<Photon> photons_on_a_line(int count) {
    std::vector<Photon> photons;
    for (int i = 0; i < count; ++i) photons.push_back(photon_at({static_cast<float>(i), 0, 0}));
    return photons;
}

/// Nodes that a search for the nearest photons of a place on the line visits.
std::uint64_t visited_nodes(TreeKind kind, float x, std::size_t nearest) {
    const auto tree = build_tree(kind, store_of(photons_on_a_line(1'000)), widest_isa());
    GatherScratch scratch;
    const std::vector<ReceiverPoint> points{point_at({x, 0, 0}, {0, 0, 1})};
    tree->gather(points, {.nearest = nearest, .max_radius = 1e4F}, scratch,
                 [](std::size_t, const GatheredPhotons&) {});
    return scratch.visited_nodes;
}

TEST(PhotonTree, SearchesCountTheNodesThatTheyVisit) {
    // Each node, where all photons are asked for.
    for (const TreeKind kind : {TreeKind::balanced, TreeKind::unbalanced})
        EXPECT_EQ(visited_nodes(kind, 500, 1'000), 1'000U) << name(kind);
    // The end of a list is reached past all of it, the end of a balanced tree past a few of each level.
    EXPECT_EQ(visited_nodes(TreeKind::unbalanced, 999, 1), 1'000U);
    EXPECT_GE(visited_nodes(TreeKind::balanced, 999, 1), 9U);
    EXPECT_LE(visited_nodes(TreeKind::balanced, 999, 1), 100U);
}

TEST(PhotonTree, UnbalancedTellsItsDepth) {
    std::vector<Photon> photons;
    Counters sorted;
    build_tree(TreeKind::unbalanced, store_of(photons_on_a_line(1'000)), widest_isa())
        ->add_to(sorted);
    EXPECT_EQ(sorted.at("tree_depth"), 1'000U);
    EXPECT_EQ(sorted.at("nodes_passed"), 999U * 1'000U / 2);
    // Photons at one point do not make a list.
    Counters coincident;
    build_tree(TreeKind::unbalanced, store_of(std::vector<Photon>(20'000, photon_at({1, 2, 3}))),
               widest_isa())
        ->add_to(coincident);
    EXPECT_LT(coincident.at("tree_depth"), 400U);
    // Nor do photons on a plane across an axis: they are parted along the two others.
    Rng rng(27, Stage::test, 0);
    for (int axis = 0; axis < 3; ++axis) {
        photons.clear();
        for (int i = 0; i < 10'000; ++i) {
            Vec3 at(rng.next(), rng.next(), rng.next());
            at[axis] = 0.5F;
            photons.push_back(photon_at(at));
        }
        Counters flat;
        build_tree(TreeKind::unbalanced, store_of(photons), widest_isa())->add_to(flat);
        EXPECT_LT(flat.at("tree_depth"), 100U) << axis;
    }
}

TEST(PhotonTree, RefusesPositionsThatAreNotFinite) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        std::vector<Photon> photons(100, photon_at({1, 2, 3}));
        photons[37].position[1] = bad;
        for (const TreeKind kind : kinds) {
            try {
                build_tree(kind, store_of(photons), widest_isa());
                FAIL();
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find("photon 37 "), std::string::npos);
            }
        }
    }
}

}  // namespace
}  // namespace caustics::photonmap

#include "photonmap/kd_tree.h"

#include <gtest/gtest.h>

#include <cstring>

#include "photon_sets.h"

namespace caustics {
namespace {

using test::linear_scan;
using test::photon_sets;

constexpr auto all = [](const Photon&) { return true; };

/// The 18 bytes of a photon that balancing must keep.
std::vector<std::array<unsigned char, 18>> payloads(const std::vector<Photon>& photons) {
    std::vector<std::array<unsigned char, 18>> bytes(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i)
        std::memcpy(bytes[i].data(), &photons[i], bytes[i].size());
    std::ranges::sort(bytes);
    return bytes;
}

Box box_below(const std::vector<Photon>& tree, std::size_t node) {
    if (node > tree.size()) return {};
    Box box = box_below(tree, 2 * node).merged(box_below(tree, 2 * node + 1));
    return box.extend(position(tree[node - 1]));
}

/// Every node splits the widest side of its photons' box, with the left subtree's photons not
/// above and the right subtree's not below it.
void expect_kd_tree(const std::vector<Photon>& tree) {
    for (std::size_t node = 1; node <= tree.size(); ++node) {
        const Box left = box_below(tree, 2 * node), right = box_below(tree, 2 * node + 1);
        const unsigned axis = split_axis(tree[node - 1]);
        const float split = tree[node - 1].position[axis];
        ASSERT_TRUE(left.isEmpty() || left.max()[axis] <= split) << node;
        ASSERT_TRUE(right.isEmpty() || right.min()[axis] >= split) << node;
        const Vec3 sides = box_below(tree, node).sizes();
        ASSERT_EQ(sides[axis], sides.maxCoeff()) << node;
        ASSERT_LE(tree[node - 1].flags, 2) << node;
    }
}

/// Rank by walking the tree.
void walk(std::uint64_t node, std::uint64_t count, std::vector<std::uint64_t>& in_order) {
    if (node > count) return;
    walk(2 * node, count, in_order);
    in_order.push_back(node);
    walk(2 * node + 1, count, in_order);
}

TEST(LeftBalancedTree, RankAndLeftSizeAgreeWithAWalk) {
    for (std::uint64_t count = 1; count <= 600; ++count) {
        std::vector<std::uint64_t> in_order;
        walk(1, count, in_order);
        for (std::uint64_t rank = 0; rank < count; ++rank)
            ASSERT_EQ(in_order_rank(in_order[rank], count), rank) << count;
        ASSERT_EQ(in_order_rank(1, count), left_size(count)) << count;
    }
}

TEST(KdTree, IsATreeOfTheSamePhotonsForEveryCount) {
    for (std::size_t count = 0; count <= 300; ++count) {
        for (auto& set : photon_sets(count, 11)) {
            SCOPED_TRACE(set.name + " " + std::to_string(count));
            const auto before = payloads(set.photons);
            balance(set.photons);
            ASSERT_EQ(payloads(set.photons), before);
            expect_kd_tree(set.photons);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(KdTree, DoesNotDependOnTheOrderOfArrival) {
    for (auto& set : photon_sets(1'000, 12)) {
        std::vector<Photon> reversed(set.photons.rbegin(), set.photons.rend());
        balance(set.photons);
        balance(reversed);
        for (std::size_t i = 0; i < reversed.size(); ++i)
            ASSERT_EQ(std::memcmp(&reversed[i], &set.photons[i], sizeof(Photon)), 0) << set.name;
    }
}

/// Queries at random places near the photons and exactly at photons.
std::vector<Vec3> query_points(const std::vector<Photon>& photons, int count) {
    Rng rng(13, Stage::test, photons.size());
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        if (photons.empty()) return {Vec3(1, 2, 3)};
        const Vec3 a = position(photons[rng.next_word() % photons.size()]);
        const Vec3 b = position(photons[rng.next_word() % photons.size()]);
        points.push_back(i % 3 == 0 ? a : Vec3(a + 2 * (rng.next() - 0.5F) * (b - a)));
    }
    return points;
}

template <typename Accept>
void expect_same_as_scan(const std::vector<Photon>& tree, std::size_t nearest,
                         const Accept& accept) {
    NearestSet set(nearest);
    Rng rng(14, Stage::test, nearest);
    for (const Vec3& point : query_points(tree, 40)) {
        const auto far = linear_scan(tree, point, tree.size(), 1e30F, all);
        // Radii beyond, among and exactly at the photons' distances.
        for (int i = 0; i < 3; ++i) {
            float radius2 = 1e30F;
            if (i > 0 && !far.empty()) radius2 = far[rng.next_word() % far.size()].squared_distance;
            set.reset(radius2);
            find_nearest(std::span<const Photon>(tree), point, set, accept);
            const auto expected = linear_scan(tree, point, nearest, radius2, accept);
            std::vector<Neighbour> found(set.found().begin(), set.found().end());
            ASSERT_EQ(found.size(), expected.size());
            if (found.empty()) continue;
            ASSERT_EQ(found.front().squared_distance, expected.back().squared_distance);
            std::ranges::sort(found, [](const auto& a, const auto& b) { return a < b; });
            for (std::size_t k = 0; k < found.size(); ++k) {
                ASSERT_EQ(found[k].squared_distance, expected[k].squared_distance);
                ASSERT_EQ(found[k].index, expected[k].index);
            }
        }
    }
}

TEST(KdTree, FindsTheSamePhotonsAsALinearScan) {
    for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 7U, 8U, 100U, 1'000U, 3'001U}) {
        for (auto& set : photon_sets(count, 15)) {
            balance(set.photons);
            for (const std::size_t nearest : {1U, 2U, 5U, 50U, 4'000U}) {
                SCOPED_TRACE(set.name + ", " + std::to_string(nearest) + " of " +
                             std::to_string(count));
                expect_same_as_scan(set.photons, nearest, all);
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(KdTree, FindsTheNearestOfThoseAccepted) {
    const auto from_above = [](const Photon& photon) { return incoming(photon).z() > 0; };
    for (auto& set : photon_sets(2'000, 16)) {
        SCOPED_TRACE(set.name);
        balance(set.photons);
        expect_same_as_scan(set.photons, 20, from_above);
        if (HasFatalFailure()) return;
    }
}

}  // namespace
}  // namespace caustics

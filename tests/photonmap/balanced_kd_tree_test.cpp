#include "photonmap/tree/balanced_kd_tree.h"

#include <gtest/gtest.h>

#include <cstring>

#include "photon_sets.h"

namespace caustics::photonmap {
namespace {

using test::photon_sets;

/// The 18 bytes of a photon that balancing must keep.
std::vector<std::array<unsigned char, 18>> payloads(const std::vector<Photon>& photons) {
    std::vector<std::array<unsigned char, 18>> bytes(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i)
        std::memcpy(bytes[i].data(), &photons[i], bytes[i].size());
    std::ranges::sort(bytes);
    return bytes;
}

/// The box of every subtree; node 0 and those behind the last are empty.
std::vector<Box> subtree_boxes(const std::vector<Photon>& tree) {
    std::vector<Box> boxes(2 * tree.size() + 2);
    for (std::size_t node = tree.size(); node > 0; --node) {
        boxes[node] = boxes[2 * node].merged(boxes[2 * node + 1]);
        boxes[node].extend(position(tree[node - 1]));
    }
    return boxes;
}

/// Every node splits the widest side of its photons' box, with the left subtree's photons not
/// above and the right subtree's not below it.
void expect_kd_tree(const std::vector<Photon>& tree) {
    const std::vector<Box> boxes = subtree_boxes(tree);
    for (std::size_t node = 1; node <= tree.size(); ++node) {
        const Box& left = boxes[2 * node];
        const Box& right = boxes[2 * node + 1];
        const unsigned axis = tree[node - 1].flags & 3U;
        const float split = tree[node - 1].position[axis];
        ASSERT_TRUE(left.isEmpty() || left.max()[axis] <= split) << node;
        ASSERT_TRUE(right.isEmpty() || right.min()[axis] >= split) << node;
        const Vec3 sides = boxes[node].sizes();
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

TEST(BalancedKdTree, IsATreeOfTheSamePhotonsForEveryCount) {
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

TEST(BalancedKdTree, IsTheSameOnEveryInstructionSet) {
    for (const std::size_t count : {100U, 10'000U}) {
        for (const auto& set : photon_sets(count, 12)) {
            std::vector<Photon> plain = set.photons;
            balance(plain, Isa::plain);
            for (const Isa isa : supported_isas()) {
                std::vector<Photon> photons = set.photons;
                balance(photons, isa);
                ASSERT_EQ(std::memcmp(photons.data(), plain.data(), count * sizeof(Photon)), 0)
                    << set.name << " " << name(isa);
            }
        }
    }
}

TEST(BalancedKdTree, IsTheSameOnAnyNumberOfThreads) {
    for (const std::size_t count : {40'000U, 200'001U}) {
        for (const auto& set : photon_sets(count, 14)) {
            std::vector<Photon> one = set.photons;
            balance(one);
            for (const int threads : {2, 3, 8}) {
                std::vector<Photon> photons = set.photons;
                balance(photons, widest_isa(), threads);
                ASSERT_EQ(std::memcmp(photons.data(), one.data(), count * sizeof(Photon)), 0)
                    << set.name << " " << threads;
            }
        }
    }
}

TEST(BalancedKdTree, IsATreeWhereRangesAreTooLargeForScratch) {
    for (auto& set : photon_sets(40'000, 13)) {
        SCOPED_TRACE(set.name);
        const auto before = payloads(set.photons);
        balance(set.photons);
        ASSERT_EQ(payloads(set.photons), before);
        expect_kd_tree(set.photons);
        if (HasFatalFailure()) return;
    }
}

}  // namespace
}  // namespace caustics::photonmap

#pragma once

#include <stdint.h>

namespace caustics::photonmap {

/// The shape of a left-balanced binary tree that is stored as a heap: node 1 is the root, the
/// children of node i are 2i and 2i + 1, every level but the last is full and the last is filled
/// from the left. Internal linkage, so that code for every instruction set may use it.

/// The depth of the last level of a tree of `count` >= 1 nodes; the root's is 0.
static inline unsigned last_level(uint64_t count) {
    return 63U - static_cast<unsigned>(__builtin_clzll(count));
}

static inline uint64_t nodes_on_last_level(uint64_t count) {
    return count - ((uint64_t{1} << last_level(count)) - 1);
}

/// Number of nodes in the left subtree of a tree of `count` >= 1 nodes.
static inline uint64_t left_size(uint64_t count) {
    if (count < 2) return 0;
    const uint64_t half_of_last = uint64_t{1} << (last_level(count) - 1);
    const uint64_t on_last = nodes_on_last_level(count);
    return half_of_last - 1 + (on_last < half_of_last ? on_last : half_of_last);
}

/// Number of leaves in the left subtree of a tree of `leaves` >= 2 leaves and one inner node less.
static inline uint64_t left_leaves(uint64_t leaves) { return (left_size(2 * leaves - 1) + 1) / 2; }

/// How many of the `count` nodes come before node `node` in order, left subtree before node before
/// right subtree.
static inline uint64_t in_order_rank(uint64_t node, uint64_t count) {
    // In a full tree node j of a level has before it j whole subtrees with their separators and
    // its own left subtree; every second node in order is one of the last level. Then those of
    // the last level that are missing are taken out.
    const unsigned level = last_level(node);
    const uint64_t index = node - (uint64_t{1} << level);
    const uint64_t full_rank = ((2 * index + 1) << (last_level(count) - level)) - 1;
    const uint64_t last_before = (full_rank + 1) / 2;
    const uint64_t present = nodes_on_last_level(count);
    return full_rank - (last_before > present ? last_before - present : 0);
}

/// Which leaf, from the left, node `node` >= leaves of a tree of `leaves` leaves is.
static inline uint64_t leaf_number(uint64_t node, uint64_t leaves) {
    const uint64_t first_of_last_level = uint64_t{1} << last_level(2 * leaves - 1);
    return node >= first_of_last_level ? node - first_of_last_level
                                       : node + leaves - first_of_last_level;
}

}  // namespace caustics::photonmap

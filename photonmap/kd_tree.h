#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "photonmap/nearest_set.h"
#include "photonmap/photon.h"

namespace caustics {

/// The balanced kd-tree of [J96, section 2] has no child pointers: it is a heap. Node i = 1..n is
/// photon i - 1 of the array, its children are 2i and 2i + 1, and every level but the last is full
/// while the last is filled from the left (a left-balanced tree).

/// Number of nodes in the left subtree of a left-balanced tree of `count` >= 1 nodes.
std::uint64_t left_size(std::uint64_t count);

/// How many of the `count` nodes of a left-balanced tree come before node `node` (1-based heap
/// index) in order, left subtree before node before right subtree.
std::uint64_t in_order_rank(std::uint64_t node, std::uint64_t count);

/// Turns an array of photons into the tree, in place with O(1) extra memory: the root is the
/// median along the largest interval of the photons' tight bounding box, and so on. Ties are
/// broken by the rest of the photon, so that the tree does not depend on the order of arrival.
/// Positions must be finite.
void balance(std::span<Photon> photons);

inline unsigned split_axis(const Photon& photon) { return photon.flags & 3U; }

/// Squared distance [m^2], each operation rounded to float.
inline float squared_distance(const Photon& photon, const Vec3& point) {
    const float x = photon.position[0] - point.x();
    const float y = photon.position[1] - point.y();
    const float z = photon.position[2] - point.z();
    return x * x + y * y + z * z;
}

/// Offers to `nearest` the photons of a balanced tree that can belong to it and for which
/// `accept(photon)` holds. The result is exactly that of offering all: the squared distance to a
/// splitting plane, rounded, never exceeds the rounded squared distance of a photon beyond it.
template <typename Accept>
void find_nearest(std::span<const Photon> tree, const Vec3& point, NearestSet& nearest,
                  const Accept& accept) {
    struct Pending {
        std::uint64_t node;
        float squared_distance;
    };
    std::array<Pending, 64> pending;  // at most one per level
    std::size_t pending_count = 0;
    for (std::uint64_t node = 1;;) {
        while (node <= tree.size()) {
            const Photon& photon = tree[node - 1];
            const float distance2 = squared_distance(photon, point);
            if (distance2 <= nearest.bound() && accept(photon))
                nearest.offer({distance2, static_cast<std::uint32_t>(node - 1)});
            const unsigned axis = split_axis(photon);
            const float offset = point[axis] - photon.position[axis];
            const std::uint64_t near_child = 2 * node + (offset >= 0 ? 1 : 0);
            // The last inner node may have a left child only, near or far.
            if (const std::uint64_t far_child = near_child ^ 1U; far_child <= tree.size())
                pending[pending_count++] = {far_child, offset * offset};
            node = near_child;
        }
        do {
            if (pending_count == 0) return;
            --pending_count;
        } while (pending[pending_count].squared_distance > nearest.bound());
        node = pending[pending_count].node;
    }
}

}  // namespace caustics

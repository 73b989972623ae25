#pragma once

#include "photonmap/tree/kd_tree_base.h"

namespace caustics::photonmap {

/// The photon's squared distance [m^2], each operation rounded to float.
inline float squared_distance(const Photon& photon, const float point[3]) {
    const float x = photon.position[0] - point[0];
    const float y = photon.position[1] - point[1];
    const float z = photon.position[2] - point[2];
    return x * x + y * y + z * z;
}

/// The search of a tree that has a photon at every node [J96 sec. 2], nearest side first, which counts the nodes. Tree
/// says where nodes and children are: `root()`, `photon(node)`, `index(node)`, `child(node, right)`,
/// `exists(node)`.
///
/// In place of a heap of the N nearest, candidates pile up and are cut down to N when there are half
/// as many again. The squared distance to a splitting plane, rounded, never exceeds the
/// rounded squared distance of a photon beyond it, so that no photon is missed.
template <typename Tree>
void find_nearest(const Tree& tree, const TreeKernels& kernels, const NearestQuery& query,
                  GatherScratch& scratch) {
    Candidates& found = scratch.found.candidates();
    found.count = 0;
    scratch.pending.clear();
    const std::size_t nearest = query.nearest;
    const std::size_t trigger = nearest + nearest / 2 + 32;
    bool shrunk = false;
    float bound = query.max_squared_distance;
    std::uint64_t visited = 0;
    const auto shrink = [&](std::size_t most) {
        bound = kernels.shrink(found, nearest, most, bound);
        if (found.count > most) query.drop_ties(query.tie_context, found, nearest);
        shrunk = true;
    };
    for (auto node = tree.root();;) {
        while (tree.exists(node)) {
            ++visited;
            const Photon& photon = tree.photon(node);
            const float distance2 = squared_distance(photon, query.point);
            if (distance2 <= bound &&
                (query.side == nullptr ||
                 counts_at(*query.side, photon.theta, photon.phi, photon.flags))) {
                found.squared_distance[found.count] = distance2;
                found.index[found.count++] = tree.index(node);
                if (found.count >= (shrunk ? trigger : nearest)) shrink(nearest + nearest / 8);
            }
            const unsigned axis = photon.flags & 3U;
            const float offset = query.point[axis] - photon.position[axis];
            const bool right = offset >= 0;
            const auto far = tree.child(node, !right);
            if (offset * offset <= bound && tree.exists(far))
                scratch.pending.push_back({far, offset * offset});
            node = tree.child(node, right);
        }
        for (;;) {
            if (scratch.pending.empty()) {
                if (found.count > nearest) shrink(nearest);
                scratch.visited_nodes += visited;
                return;
            }
            const GatherScratch::Pending next = scratch.pending.back();
            scratch.pending.pop_back();
            node = next.node;
            if (next.squared_distance <= bound) break;
        }
    }
}

}  // namespace caustics::photonmap

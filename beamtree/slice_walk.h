#pragma once

#include "beamtree/slice_nodes.h"

namespace caustics {

/// The walk, for the tests of one instruction set. `Eight` is made from a point and answers, as bits,
/// which boxes of a node and which triangles of a leaf may hold it.
template <typename Eight>
void walk_slices(const SliceView& tree, SliceWalk& walk) {
    const Eight eight(walk);
    while (walk.stacked > 0 && walk.found_count + slice_width <= walk.found_room) {
        const uint32_t next = walk.stack[--walk.stacked];
        if ((next & slice_leaf_bit) != 0) {
            const SliceLeaf& leaf = tree.leaves[next & ~slice_leaf_bit];
            walk.tests += leaf.count;
            for (uint32_t held = eight.may_hold(leaf); held != 0; held &= held - 1)
                walk.found[walk.found_count++] = leaf.beam[__builtin_ctz(held)];
        } else {
            const SliceNode& node = tree.nodes[next];
            walk.tests += node.count;
            for (uint32_t held = eight.inside(node); held != 0; held &= held - 1)
                walk.stack[walk.stacked++] = node.child[__builtin_ctz(held)];
        }
    }
}

}  // namespace caustics

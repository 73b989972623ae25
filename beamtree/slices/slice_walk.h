#pragma once

#include "beamtree/slices/slice_nodes.h"

namespace caustics::beamtree {

/// The walk, for the tests of one instruction set. `Eight` is made from a walk and answers, as
/// bits, which boxes of a node its points' box meets, and which triangles of a leaf may hold a
/// point.
template <typename Eight>
void walk_slices(const SliceView& tree, SliceWalk& walk) {
    const Eight eight(walk);
    uint32_t* const stack = walk.stack;
    size_t stacked = walk.stacked;
    size_t count = walk.found_count;
    uint64_t tests = walk.tests;
    const size_t room = walk.found_room - slice_width * walk.point_count;
    while (stacked > 0 && count <= room) {
        const uint32_t next = stack[--stacked];
        const uint32_t taken = (next >> slice_count_shift) % slice_width + 1;
        if ((next & slice_leaf_bit) == 0) {
            const SliceNode& node = tree.nodes[next & slice_number_mask];
            tests += taken;
            for (uint32_t met = eight.meets(node); met != 0; met &= met - 1)
                stack[stacked++] = node.child[__builtin_ctz(met)];
            continue;
        }
        const SliceLeaf& leaf = tree.leaves[next & slice_number_mask];
        tests += static_cast<uint64_t>(taken) * walk.point_count;
        for (uint32_t point = 0; point < walk.point_count; ++point)
            for (uint32_t held = Eight::may_hold(leaf, walk.points[point]); held != 0;
                 held &= held - 1)
                walk.found[count++] = {point, leaf.beam[__builtin_ctz(held)]};
    }
    walk.stacked = stacked;
    walk.found_count = count;
    walk.tests = tests;
}

}  // namespace caustics::beamtree

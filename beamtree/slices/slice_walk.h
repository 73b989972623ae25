#pragma once

#include "beamtree/slices/slice_nodes.h"

namespace caustics::beamtree {

template <typename Thing>
inline void fetch(const Thing& thing) {
    const char* const from = reinterpret_cast<const char*>(&thing);
    for (size_t i = 0; i < sizeof(Thing); i += 64) __builtin_prefetch(from + i);
}

/// Fetches what a walk visits next.
inline void fetch_next(const SliceView& tree, const SliceWalk& walk) {
    if (walk.stacked == 0) return;
    const uint32_t next = walk.stack[walk.stacked - 1];
    if ((next & slice_leaf_bit) == 0)
        fetch(tree.nodes[next & slice_number_mask]);
    else
        fetch(tree.leaves[next & slice_number_mask]);
}

/// Visits one node or leaf. `Eight` is made from a walk and answers, as bits, which boxes of a node its points' box meets, and
/// which triangles of a leaf may hold a point.
template <typename Eight>
inline void visit(const SliceView& tree, SliceWalk& walk) {
    const uint32_t next = walk.stack[--walk.stacked];
    const uint32_t taken = (next >> slice_count_shift) % slice_width + 1;
    if ((next & slice_leaf_bit) == 0) {
        const SliceNode& node = tree.nodes[next & slice_number_mask];
        walk.tests += taken;
        for (uint32_t met = Eight(walk).meets(node); met != 0; met &= met - 1)
            walk.stack[walk.stacked++] = node.child[__builtin_ctz(met)];
        fetch_next(tree, walk);
        return;
    }
    fetch_next(tree, walk);
    const SliceLeaf& leaf = tree.leaves[next & slice_number_mask];
    walk.tests += static_cast<uint64_t>(taken) * walk.point_count;
    for (uint32_t point = 0; point < walk.point_count; ++point)
        for (uint32_t held = Eight::may_hold(leaf, walk.points[point], tree.has_bulges); held != 0;
             held &= held - 1) {
            const uint32_t beam = leaf.beam[__builtin_ctz(held)];
            walk.found[walk.found_count++] = {point, beam};
            for (size_t i = 0; i < tree.beam_bytes; i += 64)
                __builtin_prefetch(tree.beams + beam * tree.beam_bytes + i);
        }
}

/// Goes on with one walk until it ends or pauses: of points side by side, whose nodes are in the cache mostly.
template <typename Eight>
void walk_alone(const SliceView& tree, SliceWalk& walk) {
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
            for (uint32_t held = Eight::may_hold(leaf, walk.points[point], tree.has_bulges);
                 held != 0; held &= held - 1)
                walk.found[count++] = {point, leaf.beam[__builtin_ctz(held)]};
    }
    walk.stacked = stacked;
    walk.found_count = count;
    walk.tests = tests;
}

/// The walks, for the tests of one instruction set: those of several points one after the other, those of scattered points by
/// turns.
template <typename Eight>
void walk_slices(const SliceView& tree, SliceWalk* walks, size_t count) {
    constexpr uint32_t several = 3;
    for (size_t i = 0; i < count; ++i)
        if (walks[i].point_count >= several) walk_alone<Eight>(tree, walks[i]);
    for (bool more = true; more;) {
        more = false;
        for (size_t i = 0; i < count; ++i) {
            SliceWalk& walk = walks[i];
            const size_t room = walk.found_room - slice_width * walk.point_count;
            if (walk.stacked == 0 || walk.point_count >= several || walk.found_count > room)
                continue;
            visit<Eight>(tree, walk);
            more = true;
        }
    }
}

}  // namespace caustics::beamtree

#pragma once

#include <stddef.h>
#include <stdint.h>

namespace caustics::beamtree {

/// The memory of a tree of slices (slice_tree.h), eight things side by side: plain data, so that a
/// source compiled for wide registers includes no inline code of Eigen or the standard library.
///
/// Everything stands at two planes across the tree's axis and moves linearly between them: at the
/// share t of the way from the upper plane to the lower one a quantity is top + t * growth.
constexpr size_t slice_width = 8;

/// Which child: the number of a node, or with this bit of a leaf; and how many places of it are
/// taken, less one.
constexpr uint32_t slice_leaf_bit = 1U << 31;
constexpr uint32_t slice_count_shift = 28;
constexpr uint32_t slice_number_mask = (1U << slice_count_shift) - 1;

/// Boxes that hold the children's beams at every height between the planes. Places that are not
/// taken have boxes that hold nothing.
struct alignas(64) SliceNode {
    float low[2][slice_width];  ///< along both axes of the plane
    float low_growth[2][slice_width];
    float high[2][slice_width];
    float high_growth[2][slice_width];
    float begun_from[slice_width];  ///< share above which none of the child's rays has begun
    uint32_t child[slice_width];
};

/// Triangles of beams: where the rays of their corners meet the planes.
struct alignas(64) SliceLeaf {
    float corner[3][2][slice_width];  ///< at the upper plane
    float growth[3][2][slice_width];
    /// Twice an area: edges that pass the point on the wrong side by less may be rounding. Negative
    /// in places that are not taken.
    float slack[slice_width];
    /// By how much points may lie off the box of the corners, along both axes [m].
    float room[2][slice_width];
    /// The shares t from which on one of the three rays has begun, and all. Between the two the
    /// triangle is clipped, which this test leaves to the exact one.
    float begun_from[slice_width];
    float whole_from[slice_width];
    uint32_t beam[slice_width];  ///< as the tree numbers them
};

struct SliceView {
    const SliceNode* nodes;
    const SliceLeaf* leaves;
    /// What lies beside the leaves, beam by beam: fetched for those that are found.
    const char* beams;
    size_t beam_bytes;
    /// True where triangles hold points beside their straight-sided images: then their boxes are asked as well.
    bool has_bulges;
};

/// A point of the slab.
struct SlicePoint {
    float at[2];
    float share;  ///< of the way down, in [0, 1]
    /// What lies so near along both axes is to be found as well [m]; 0: triangles that hold the point.
    float reach[2];
    float last_share;  ///< of the lowest thing near it that is asked about
};

/// A beam a triangle of which may hold a point.
struct SliceCandidate {
    uint32_t point;
    uint32_t beam;
};

/// A walk of some points near each other through a tree: nodes are asked about the box round the
/// points, triangles about each. It pauses while `found` is full, and has ended when the stack is
/// empty.
struct SliceWalk {
    const SlicePoint* points;
    uint32_t point_count;
    float low[2];  ///< of the points
    float high[2];
    float least_share;
    float most_share;
    uint32_t* stack;  ///< what is still to be visited; room for 7 entries a level and the root
    size_t stacked;
    SliceCandidate* found;  ///< those of a leaf and a point side by side, triangle by triangle
    size_t found_room;      ///< at least slice_width for each point
    size_t found_count;
    uint64_t tests;  ///< boxes, and triangles for each point, that were tested
};

/// Goes on with some walks, by turns so that one computes while another waits for memory, until each ends or its `found` might
/// not hold what the next leaf has. Every instruction set visits the same nodes, finds the same beams in the same order, to
/// the bit.
using WalkSlices = void (*)(const SliceView&, SliceWalk* walks, size_t count);

void walk_slices_plain(const SliceView&, SliceWalk* walks, size_t count);
void walk_slices_avx2(const SliceView&, SliceWalk* walks, size_t count);

}  // namespace caustics::beamtree

#pragma once

#include <span>

#include "beamtree/beams/hierarchy.h"
#include "beamtree/slices/slice_box.h"

namespace caustics::beamtree {

/// A beam of a slice tree and the boxes that hold it.
struct BoxedBeam {
    SliceBox box;
    std::uint32_t beam = 0;  ///< as the tree numbers them
};

/// For any beams of a slab: binary, split by 16 bins along the coordinate of the box centres (two
/// on the upper plane, two on the lower one) whose halves have the least sum of n times the mean
/// area of their boxes [MacDonald and Booth 1990, for points that may be at any height]. Down to
/// `leaf_size` beams. Sorts the beams into the order of the tree, the same with any number of threads.
Hierarchy binned_slices(std::span<BoxedBeam> beams, std::uint32_t leaf_size, int threads = 1);

}  // namespace caustics::beamtree

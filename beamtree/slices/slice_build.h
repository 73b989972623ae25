#pragma once

#include <span>
#include <vector>

#include "beamtree/beams/hierarchy.h"
#include "beamtree/slices/slice_box.h"
#include "beamtree/slices/slice_nodes.h"

namespace caustics::beamtree {

/// A triangle of a beam as a leaf holds it.
struct SlicedTriangle {
    std::array<RaySlices, 3> corners;
    SliceReach drift = {};   ///< how far any of them moves with the wavelength
    SliceReach bulge = {};   ///< how far its light may lie beside its straight-sided image
    float begun_from = 0;    ///< share of the way down from which one of its rays has begun
    float whole_from = 0;    ///< and from which all have
    std::uint32_t beam = 0;  ///< as the tree numbers them
};

/// The nodes of a tree of slices.
struct SliceNodes {
    std::vector<SliceNode> nodes;
    std::vector<SliceLeaf> leaves;
    std::uint32_t root = 0;
    std::uint32_t height = 0;  ///< nodes on the longest way down
    float leaf_width = 0;      ///< mean, over both planes [m]
    float travel = 0;          ///< how far rays move from one plane to the other, mean [m]
    bool has_bulges = false;
};

/// Makes a hierarchy eight wide by opening the child with most triangles again and again.
/// `triangles` are in the order of the hierarchy's beams; those of one beam side by side. The same with any number of
/// threads.
SliceNodes widen(const Hierarchy& hierarchy, std::span<const SlicedTriangle> triangles,
                 int threads = 1);

}  // namespace caustics::beamtree

#pragma once

#include "beamtree/beams/beam_params.h"
#include "beamtree/cones/cone_tree.h"
#include "beamtree/tracing/beam_tracing.h"

namespace caustics::beamtree {

/// `beamtree` [CC95]: the light that each specular polygon sends on is a beam; the beams of each
/// light are found from a receiver point through a tree of cones.
struct BeamTreeParams : BeamParams {
    enum class Tree {
        quadtree,  ///< of a regular subdivision; casters that have none get `binned`, and the report
                   ///< reports how many
        binned
    };
    enum class Leaf {
        n,  ///< caustic polygons on the plane across the receiver's normal, as the paper says
        k   ///< on planes across a normal fixed for the tree
    };
    Bound bound = Bound::hybrid;
    double spread_threshold = 10;  ///< of `hybrid` [degrees]
    ConeTreeSettings::Merging merging = ConeTreeSettings::Merging::rays;
    Tree hierarchy = Tree::quadtree;  ///< where the bound is two_slice and nothing is said: binned
    Leaf leaf = Leaf::n;              ///< with two_slice always k
    Intensity intensity = Intensity::area;
    /// Side of the square round each point, on the tree's planes, over which its irradiance is averaged
    /// exactly [m]; 0: at the point alone. Only with the bound two_slice; beams that spread too far for
    /// a fixed plane, and polygons that the plane cuts, are asked at the point.
    float footprint = 0;
};

}  // namespace caustics::beamtree

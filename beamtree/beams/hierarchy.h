#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/beam.h"
#include "core/geometry/mesh.h"

namespace caustics::beamtree {

/// Which beams belong together: nodes whose children lie side by side, leaves of one beam each.
struct Hierarchy {
    struct Node {
        std::uint32_t first_beam = 0;  ///< into `order`
        std::uint32_t beam_count = 0;
        std::uint32_t first_child = 0;  ///< 0: a leaf
        std::uint32_t child_count = 0;
    };
    std::vector<Node> nodes;           ///< the root first; children after their parents
    std::vector<std::uint32_t> order;  ///< beam numbers

    std::uint32_t height() const;  ///< nodes on the longest way down
};

/// The quadtree of a mesh's regular subdivision (row B6): four quarters down to a cell, then its
/// beams, of which a triangle may have any number. Beams of triangles outside of the patches are a
/// part of their own beside them. `beams`, at least one, are numbers into `set`.
Hierarchy quadtree(const BeamSet& set, std::span<const std::uint32_t> beams,
                   std::span<const GridPatch> patches);

/// For any polygons ([CC95 sec. 4], future work): binary, split by 16 bins along the axis of
/// (position, reach * direction) whose halves have the least sum of n (their diagonals)^2.
/// `reach` is a typical distance to the receivers [m]; 0 splits by position alone.
Hierarchy binned_hierarchy(const BeamSet& set, std::span<const std::uint32_t> beams, float reach);

}  // namespace caustics::beamtree

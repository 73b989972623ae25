#pragma once

#include <span>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/hierarchy.h"
#include "core/mesh/mesh.h"

namespace caustics::beamtree {

/// The quadtree of a mesh's regular subdivision (row B6): four quarters down to a cell, then its
/// beams, of which a triangle may have any number. Beams of triangles outside of the patches are a
/// part of their own beside them. `beams`, at least one, are numbers into `set`.
Hierarchy quadtree(const BeamSet& set, std::span<const std::uint32_t> beams,
                   std::span<const GridPatch> patches);

}  // namespace caustics::beamtree

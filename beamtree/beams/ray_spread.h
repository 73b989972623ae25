#pragma once

#include <span>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/mesh_neighbours.h"
#include "beamtree/beams/ray_origin.h"
#include "beamtree/beams/trace_progress.h"

namespace caustics::beamtree {

/// Gives the set its spreads and partners (`intensity: refined`). A vertex ray's spread comes from
/// the derivatives of first surface, place and direction, of a quadratic surface fitted to the rays
/// of the vertices round it; their errors are of second order on any mesh. Rays that start at no
/// vertex, or have too few neighbours that whole beams join to them, have no spread; nor those of which no beam
/// is `kept` (one a beam).
void refine(BeamSet& set, std::span<const RayOrigin> origins, const MeshNeighbours& neighbours,
            const std::vector<bool>& kept, int threads, const ProgressPart& part);

}  // namespace caustics::beamtree

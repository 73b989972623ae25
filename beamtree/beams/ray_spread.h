#pragma once

#include <array>
#include <span>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/mesh_neighbours.h"
#include "beamtree/beams/ray_origin.h"
#include "beamtree/beams/trace_progress.h"

namespace caustics::beamtree {

/// How a ray changes as its start on the first surface moves along two ways.
struct RayDerivatives {
    std::array<Vec3d, 2> surface;    ///< the start itself
    std::array<Vec3d, 2> place;      ///< where the light was bent last
    std::array<Vec3d, 2> direction;  ///< in which it leaves
};

/// Of a ray that has come from `origin`; not known where the derivatives tell nothing.
RaySpread spread_of(const VertexRay& ray, const RayOrigin& origin, const LightSample& light,
                    const RayDerivatives& by);

/// Gives the set its spreads and partners (`intensity: refined`). A vertex ray's spread comes from
/// the derivatives of first surface, place and direction, of a quadratic surface fitted to the rays
/// of the vertices round it; their errors are of second order on any mesh. Rays that start at no
/// vertex, or have too few neighbours that whole beams join to them, get none here; nor those of which no beam
/// is `kept` (one a beam).
void refine(BeamSet& set, std::span<const RayOrigin> origins, const MeshNeighbours& neighbours,
            const std::vector<bool>& kept, int threads, const ProgressPart& part);

}  // namespace caustics::beamtree

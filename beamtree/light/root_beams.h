#pragma once

#include <vector>

#include "beamtree/beams/ray_origin.h"
#include "core/mesh/mesh.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// Prepares a set for the search of its roots (RootSearch): gives it the rays of its edges' middles (BeamSet::middles) and
/// the places of its rays on the first surface. Triangles whose image is far from a quadratic, as corners and middles
/// tell it, are quartered, up to three times. A triangle of `polygons`, the first surface's mesh, that the set has in part
/// becomes one beam (cut_triangles.h). Where light of a corner or middle does not go the set's way, the last place
/// towards the triangle's lit part from which it does stands for it.
void prepare_roots(const Scene& scene, const TriangleMesh& polygons,
                   const std::vector<RayOrigin>& origins, int threads, BeamSet& set);

}  // namespace caustics::beamtree

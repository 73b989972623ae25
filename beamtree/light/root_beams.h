#pragma once

#include <vector>

#include "beamtree/beams/ray_origin.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// Prepares a set for the search of its roots (RootSearch): gives it the rays of its edges' middles (BeamSet::middles) and
/// the places of its rays on the first surface. Triangles whose image is far from a quadratic, as corners and middles
/// tell it, are quartered, up to four times. Where light of a middle does not go the way of the corners, the mean of its
/// edge's ends stands for it.
void prepare_roots(const Scene& scene, const std::vector<RayOrigin>& origins, int threads,
                   BeamSet& set);

}  // namespace caustics::beamtree

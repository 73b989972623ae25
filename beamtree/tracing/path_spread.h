#pragma once

#include <vector>

#include "beamtree/tracing/beam_path.h"

namespace caustics::beamtree {

/// Gives rays of a refined set (ray_spread.h) that have no spread one from the ways of two points beside each on the
/// first surface, where that is flat between the corners of a beam of theirs, and light of the two goes the beam's way,
/// by the same facets where later surfaces are shaded flat.
/// Only rays of beams that are `kept` (one a beam).
void spread_along_paths(const Scene& scene, const LitCaster& surface, Level& level,
                        const std::vector<bool>& kept, int threads);

}  // namespace caustics::beamtree

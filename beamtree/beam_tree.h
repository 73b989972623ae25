#pragma once

#include <memory>

#include "beamtree/beam_tree_params.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// Phases "beams" and "tree". Counters: polygons, beams, trees, nodes, height (of the highest
/// tree), cone_point_tests, beam_point_tests, beam_point_hits. Throws UnsupportedScene where beams
/// lose most of the light on its way to further specular surfaces.
std::unique_ptr<const CausticEstimator> build(const Scene& scene, const BeamTreeParams& params,
                                              const RunOptions& options);

}  // namespace caustics::beamtree

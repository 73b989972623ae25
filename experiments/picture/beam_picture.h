#pragma once

#include "beamtree/beam_tree.h"
#include "experiments/picture/previews.h"

namespace caustics {

/// The caustic polygons of a scene's beams over its dim picture by `beamtree`, through its camera,
/// where that sees them directly: polygons whose light has not passed through a caustic in orange,
/// those turned over in blue, and the edges between the two, where the caustic is, in white.
Picture draw_beams(const Scene& scene, const BeamTreeParams& params, const RunOptions& options);
/// The same with the parameters of `beamtree` still to be read.
Picture draw_beams(const Scene& scene, const JsonNode& params, const RunOptions& options);

}  // namespace caustics

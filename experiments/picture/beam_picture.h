#pragma once

#include "core/caustic_estimator.h"
#include "core/scene/scene.h"
#include "core/scene_file/json_reader.h"
#include "experiments/picture/previews.h"

namespace caustics::experiments {

/// The caustic polygons of a scene's beams over its dim picture by `beamtree`, through its camera,
/// where that sees them directly: polygons whose light has not passed through a caustic in orange,
/// those turned over in blue, and the edges between the two, where the caustic is, in white.
/// `params` are those of `beamtree`.
Picture draw_beams(const Scene& scene, const JsonNode& params, const RunOptions& options);

}  // namespace caustics::experiments

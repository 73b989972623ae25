#pragma once

#include <vector>

#include "beamtree/beams/caster_mesh.h"
#include "beamtree/tracing/caster_beams.h"
#include "core/run_options.h"

namespace caustics::beamtree {

/// The light [W] that the brightest beams of several events, `max_beams` of them, have at least, as polygons
/// drawn at random tell: so that tracing need not follow what will not be kept. 0 where all have room.
double expected_least(const Scene& scene, const SceneBoxes& boxes,
                      const std::vector<CasterMesh>& casters,
                      const std::vector<LightSample>& lights, const TraceSettings& settings,
                      const RunOptions& options);

}  // namespace caustics::beamtree

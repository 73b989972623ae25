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

/// Answers by polygons drawn at random whether there are at most `max_beams` beams of several events that are bright enough
/// (`prune`).
bool beams_fit(const Scene& scene, const std::vector<CasterMesh>& casters,
               const std::vector<LightSample>& lights, const TraceSettings& settings,
               const RunOptions& options);

/// How many polygons are drawn for that, where there are so many, counted once a light: about as many as make enough
/// beams of those that are kept, but no more than there are, or than a few. So a small budget costs little.
std::size_t draw_count(double polygons, std::uint64_t max_beams);

}  // namespace caustics::beamtree

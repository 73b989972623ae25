#pragma once

#include <vector>

#include "beamtree/tracing/caster_beams.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// All sets that hold a beam: lights outermost, then first casters, reflection before refraction, each
/// set before those that its light reaches. With `refined` they have spreads.
TracedBeams trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                            const std::vector<LightSample>& lights, const TraceSettings& settings,
                            const RunOptions& options);
/// Those of the paper: one event, without spreads.
std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options);

}  // namespace caustics::beamtree

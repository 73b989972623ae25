#pragma once

#include <cstdint>

#include "beamtree/beams/beam_params.h"
#include "beamtree/beams/flux_balance.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// What some of a scene's polygons tell of the beams of all.
struct SceneSample {
    std::uint64_t polygons_sampled = 0;
    std::uint64_t polygons = 0;  ///< of all casters
    FluxBalance balance;         ///< expected of all, but for light too weak for the sample

    BuildReport report() const;
};

/// Counts the polygons of all casters, with exact ones tessellated.
std::uint64_t count_polygons(const Scene& scene, int mesh_resolution);

/// Traces beams of polygons drawn at random, as far as they have light to speak of, until their number is enough to
/// judge by. The work is bounded, whatever the scene. Throws what trace_scene throws, as far as the sample tells.
SceneSample sample_scene(const Scene& scene, const std::string& method, const BeamParams& params,
                         const RunOptions& options);

}  // namespace caustics::beamtree

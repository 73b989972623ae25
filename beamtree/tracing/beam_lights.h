#pragma once

#include <string>
#include <vector>

#include "beamtree/beams/beam_params.h"
#include "beamtree/beams/light_sample.h"
#include "core/run_options.h"

namespace caustics::beamtree {

/// What a scene's beams start from, in parts by wavelength where glass disperses light. Throws
/// UnsupportedScene, in the name of `method`, for a light that is at no place and of no direction, or that lies on a caster.
std::vector<LightSample> beam_lights(const Scene& scene, const std::string& method,
                                     const BeamParams& params, const RunOptions& options);

}  // namespace caustics::beamtree

#pragma once

#include <memory>
#include <string>

#include "beamtree/beams/beam_params.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// What stands for a method's beams where only is asked whether they can serve the scene
/// (BeamParams::sampled): its report is that of a sample, and it answers no points. Throws as trace_scene.
std::unique_ptr<const CausticEstimator> sampled_beams(const Scene& scene, const std::string& method,
                                                      const BeamParams& params,
                                                      const RunOptions& options);

}  // namespace caustics::beamtree

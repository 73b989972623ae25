#include "beamtree/sampled_beams.h"

#include "beamtree/scene_sample.h"
#include "core/method/unlit_estimator.h"

namespace caustics::beamtree {

std::unique_ptr<const CausticEstimator> sampled_beams(const Scene& scene, const std::string& method,
                                                      const BeamParams& params,
                                                      const RunOptions& options) {
    options.phase("beams");
    return std::make_unique<UnlitEstimator>(sample_scene(scene, method, params, options).report());
}

}  // namespace caustics::beamtree

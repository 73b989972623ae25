#pragma once

#include <vector>

#include "beamtree/beam.h"
#include "core/caustic_estimator.h"

namespace caustics {

/// Flux of the beams that are lit, and of those among them that next meet another specular surface,
/// judged at each beam's middle [W, mean of channels]. The method follows one event only.
struct FluxBalance {
    double lit = 0;
    double to_casters = 0;
    double share() const { return lit > 0 ? to_casters / lit : 0; }
};
FluxBalance flux_balance(const Scene& scene, const std::vector<BeamSet>& sets,
                         const RunOptions& options);

}  // namespace caustics

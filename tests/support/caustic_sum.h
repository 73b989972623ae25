#pragma once

#include "core/caustic_estimator.h"
#include "core/scene/scene.h"

namespace caustics::support {

/// Sum of a picture's caustic (green) over the pixels that light paths reach.
double caustic_sum(const Scene& scene, const CausticEstimator& estimator,
                   const RunOptions& options);

}  // namespace caustics::support

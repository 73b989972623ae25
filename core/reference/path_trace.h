#pragma once

#include <memory>

#include "core/caustic_estimator.h"
#include "core/light_path/bounce_limit.h"
#include "core/method/described_method.h"

namespace caustics {

/// `pathtrace`: unidirectional path tracing of L S+ D from the receiver, directions drawn by
/// multiple importance sampling from the receiver's BSDF and from the casters' bounds. Unbiased;
/// needs lights with area (throws UnsupportedScene for point and directional lights).
struct PathTraceParams {
    int spp = 16;  ///< paths a pixel, shared among the eye pass's samples (at least one each); in
                   ///< `probe`, paths a point
    int max_bounces = most_bounces;  ///< specular events between light and receiver
};
const DescribedMethod<PathTraceParams>& pathtrace_method();
std::unique_ptr<const CausticEstimator> build(const Scene&, const PathTraceParams&,
                                              const RunOptions&);

}  // namespace caustics

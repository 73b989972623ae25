#pragma once

#include <memory>

#include "core/indirect_estimator.h"
#include "core/light_path/bounce_limit.h"
#include "core/method/described_method.h"

namespace caustics {

/// `pathtrace` of indirect light: paths from the receiver through diffuse surfaces, at each of which the
/// direct light is sampled (next-event estimation) and the caustic by one more chain. Unbiased. Throws
/// UnsupportedScene where casters send light of points or directions to other walls, which no path meets.
struct IndirectPathTraceParams {
    int spp = 16;                    ///< as PathTraceParams::spp
    int max_bounces = most_bounces;  ///< specular events between two receivers
    int diffuse_bounces = 0;         ///< the last receiver, counted from the light [C11]; 0: none
};
const DescribedMethod<IndirectPathTraceParams, IndirectEstimator>& indirect_pathtrace_method();
std::unique_ptr<const IndirectEstimator> build(const Scene&, const IndirectPathTraceParams&,
                                               const RunOptions&);

}  // namespace caustics

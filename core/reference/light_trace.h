#pragma once

#include <cstdint>
#include <memory>

#include "core/caustic_estimator.h"
#include "core/indirect_estimator.h"
#include "core/light_path/bounce_limit.h"
#include "core/method/described_method.h"

namespace caustics {

/// `lighttrace`: particles from the lights through the casters to a receiver, there connected to
/// the pinhole (render) or gathered over a disc round the point (probe). Unbiased up to the disc's
/// average; serves every light; cannot reach pixels that see the receiver through a specular
/// surface. Where no path came to a disc, the standard error is that of one path. Counters: those of LightPathCounts and, in render, `photons_connected` to the pinhole.
struct LightTraceParams {
    enum class Emission {
        random,
        stratified  ///< most of the paths in four batches of jittered strata, whose scatter is the standard error
    };
    std::uint64_t paths = 1'000'000;  ///< emitted, thinned ones included
    int max_bounces = most_bounces;   ///< specular events between light and receiver
    double radius = 0;                ///< [m] of the disc in `probe` for points without their own
    Emission emission = Emission::random;  ///< of caustics
};
/// The same of indirect light: whole paths, from the second receiver on.
struct IndirectLightTraceParams : LightTraceParams {
    int diffuse_bounces = 0;  ///< the last receiver, counted from the light [C11]; 0: none
};
const DescribedMethod<LightTraceParams>& lighttrace_method();
const DescribedMethod<IndirectLightTraceParams, IndirectEstimator>& indirect_lighttrace_method();
std::unique_ptr<const CausticEstimator> build(const Scene&, const LightTraceParams&,
                                              const RunOptions&);
std::unique_ptr<const IndirectEstimator> build(const Scene&, const IndirectLightTraceParams&,
                                               const RunOptions&);

}  // namespace caustics

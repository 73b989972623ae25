#pragma once

#include <memory>

#include "core/indirect_estimator.h"
#include "core/method/described_method.h"
#include "photonmap/photons/global_map_params.h"

namespace caustics::photonmap {

/// `gather` M > 0: M rays from each point, by the directions that photons near it came from; where a ray
/// meets a receiver (through specular surfaces), the radiance that the map of all photons has there: on
/// diffuse surfaces from the irradiance known at the nearest of every `precompute`-th photon, on others, and
/// under smooth normals that lean by more than 6 degrees, from the photons themselves. `gather` 0: the density
/// of the photons that came from diffuse surfaces, at the point itself. Phases "trace", "balance" and
/// "precompute". Throws as trace_global.
std::unique_ptr<const IndirectEstimator> build(const Scene& scene, const GlobalMapParams& params,
                                               const RunOptions& options);

const DescribedMethod<GlobalMapParams, IndirectEstimator>& globalphotonmap_method();

}  // namespace caustics::photonmap

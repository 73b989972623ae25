#pragma once

#include <functional>
#include <vector>

#include "core/light_path/aimed_emission.h"
#include "core/math/rng.h"
#include "core/scene/scene.h"
#include "tests/support/statistics.h"

namespace caustics::support {

/// Where a particle comes from: a LightParticle, or nothing when the path was thinned out.
using Emit = std::function<std::optional<LightParticle>(Rng&)>;

/// Particles as AimedEmission sends them.
Emit aimed(const AimedEmission& emission);
/// Particles sent without any aim, for comparison: a point light over the whole sphere, an area
/// light over its front by the cosine, a directional light over the disc of the scene's bounding
/// sphere.
Emit unaimed(const Scene& scene, const Light& light);

/// Flux that arrived in each of a number of cells [W].
struct ArrivedFlux {
    std::vector<double> mean;
    std::vector<double> standard_error;
    LightPathCounts counts;

    double total() const;
};

/// Traces `paths` particles through the casters and adds up the mean of the channels of the flux
/// they bring to each cell; `cell_of` answers -1 for deposits that do not count.
ArrivedFlux arrived_flux(const Scene& scene, const Emit& emit, std::uint64_t paths,
                         std::size_t cells, const std::function<int(const Deposit&)>& cell_of,
                         std::uint64_t seed, int max_bounces = most_bounces);

/// The flux that arrives on each shape.
ArrivedFlux flux_by_shape(const Scene& scene, const Emit& emit, std::uint64_t paths,
                          std::uint64_t seed, int max_bounces = most_bounces);

}  // namespace caustics::support

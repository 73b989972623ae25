#pragma once

#include "core/light_path/light_path.h"

namespace caustics {

struct WholePathSettings {
    int max_bounces = most_bounces;  ///< specular events between two receivers
    /// The receiver at which a path ends, counted from the light [C11]; 0: none.
    int diffuse_bounces = 0;
};

/// Follows a particle through all events, L (S* D)*, with one decision by Russian roulette for reflection,
/// refraction, diffuse reflection or an end at each surface; the survivor's channels are rescaled. Appends
/// what it leaves on every receiver, in the order of the path; `counts.missed` are those that meet nothing.
/// Throws InputError for a path that would not end: closed scenes have to absorb light.
void trace_whole_path(const Scene& scene, const LightParticle& particle,
                      const WholePathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits);

/// Throws InputError for so many diffuse reflections that the path does not seem to end.
void require_end(int diffuse_bounces);

}  // namespace caustics

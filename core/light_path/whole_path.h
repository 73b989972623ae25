#pragma once

#include "core/light_path/light_path.h"

namespace caustics {

struct WholePathSettings {
    int max_bounces = 16;  ///< specular events between two receivers
    int diffuse_bounces =
        0;  ///< the receiver at which a path ends, counted from the light; 0: none [C11]
};

/// Follows a particle through all events, L (S* D)*, with one decision by Russian roulette for reflection,
/// refraction, diffuse reflection or an end at each surface; the survivor's channels are rescaled. Appends
/// what it leaves on every receiver, in the order of the path; `counts.missed` are those that meet nothing.
/// Throws InputError for a path that would not end: closed scenes have to absorb light.
void trace_whole_path(const Scene& scene, const LightParticle& particle,
                      const WholePathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits);

/// Throws InputError when so many diffuse reflections are no path that ends.
void require_end(int diffuse_bounces);

}  // namespace caustics

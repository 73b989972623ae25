#pragma once

#include <cstdint>
#include <string>

#include "core/light_path/empty_caustic.h"
#include "photonmap/photons/photon_tracing.h"

namespace caustics::photonmap {

/// The seed of the light paths that decide whether photons can be stored: not the run's, so that a scene is refused
/// for all seeds or for none.
inline constexpr std::uint64_t seed_of_yield = 0;

struct WantedPhotons {
    std::uint64_t count = 0;
    Spectrum path_flux;           ///< as that of trace_photons()
    std::string method;           ///< its name
    std::string otherwise;        ///< what to ask for instead of so many
    std::string when_hardly_any;  ///< the same where hardly a photon comes; empty: nothing helps
    std::string (*why_none)(const LightPathCounts& counts) = why_nothing_arrives;
};

/// Throws UnsupportedScene unless light paths bring enough photons that so many can be stored. Follows up to two
/// million of `paths`, which draw random numbers by seed_of_yield. Refuses where fewer than 16 photons come, or
/// where fewer than one in 2,000 paths brings one and more than 50 million paths were needed.
void require_yield(const PathTracer& paths, const WantedPhotons& wanted);

}  // namespace caustics::photonmap

#pragma once

#include <cstdint>
#include <filesystem>

#include "core/light_path/bounce_limit.h"

namespace caustics::photonmap {

/// `globalphotonmap` [Jensen 1996, sec. 6], [C11]: photons of all lights, stored at every diffuse surface; the
/// light between surfaces by final gathering, or straight from the map.
struct GlobalMapParams {
    std::uint64_t photons = 200'000;  ///< to store
    int max_bounces = most_bounces;   ///< specular events between two receivers
    int diffuse_bounces = 0;          ///< the receiver at which a photon ends [C11]; 0: by roulette
    int nearest = 50;                 ///< N of an estimate, at least 2
    double max_radius = 0;            ///< [m]; 0: chosen from the photons
    int gather = 32;                  ///< M rays from each point; 0: the map itself is shown
    int precompute = 4;  ///< K: irradiance known at every K-th photon; 0: estimated at each end
    std::uint64_t shadow_photons = 0;  ///< rays of each light; 0: every shadow ray is traced
    /// Files that the photons are written to and come from, as PhotonMapParams::save and load.
    std::filesystem::path save = {};
    std::filesystem::path load = {};
};

}  // namespace caustics::photonmap

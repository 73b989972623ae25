#pragma once

#include <filesystem>
#include <string>

#include "experiments/picture/previews.h"
#include "photonmap/photons/photon_source.h"

namespace caustics::experiments {

/// What a photon map's file holds, as `info` prints it.
std::string describe_map(const std::filesystem::path& file, const photonmap::SavedPhotons& saved);

/// The photons as dots of `radius` pixels through the scene's camera, over a dim picture of its direct
/// light; as bright as the logarithm of their number, the densest white.
Picture draw_photons(const Scene& scene, photonmap::TracedPhotons photons, double radius,
                     const RunOptions& options);

}  // namespace caustics::experiments

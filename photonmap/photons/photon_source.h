#pragma once

#include <functional>

#include "core/caustic_estimator.h"
#include "photonmap/photons/global_map_params.h"
#include "photonmap/photons/photon_map_file.h"
#include "photonmap/photons/scene_photons.h"

namespace caustics::photonmap {

/// The photons that a map stands on: traced in phase "trace", or those of the file `params.load`, in
/// phase "load"; and written to `params.save`, in phase "save". A file that cannot be written to is
/// reported before anything is traced. Throws InputError when the loaded photons are not those of the
/// scene, or of another kind of map: require_transport.
SavedPhotons photon_source(const Scene& scene, const PhotonMapParams& params,
                           const RunOptions& options, AskYield ask);
/// The same of a global map.
SavedPhotons photon_source(const Scene& scene, const GlobalMapParams& params,
                           const RunOptions& options);

/// Throws InputError naming the file unless the photons are those of the scene: its transport_hash, or that
/// of whole paths, is another.
void require_transport(const PhotonOrigin& origin, const Scene& scene,
                       const std::filesystem::path& file);

}  // namespace caustics::photonmap

#pragma once

#include "core/scene/scene.h"
#include "photonmap/photons/global_map_params.h"
#include "photonmap/photons/photon_tracing.h"

namespace caustics::photonmap {

/// Traces whole light paths until exactly `params.photons` are stored: a pilot says how many paths bring a
/// few more, and those beyond are dropped at random (drop_photons), so that the flux stays unbiased. Photons
/// that come from a diffuse surface have from_diffuse_mark. Throws UnsupportedScene where no light arrives
/// anywhere, InputError where its paths do not end (trace_whole_path).
TracedPhotons trace_global(const Scene& scene, const GlobalMapParams& params,
                           const RunOptions& options);

/// The photons of a global map that come from a diffuse surface, without their mark; the mark of all is taken
/// off.
PhotonStore take_indirect(PhotonStore& photons);

}  // namespace caustics::photonmap

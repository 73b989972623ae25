#pragma once

#include <memory>

#include "core/caustic_estimator.h"
#include "photonmap/photons/photon_map_params.h"

namespace caustics::photonmap {

/// Builds the map of pass 0, 1, ..., passes - 1; the passes' radiance is to be averaged.
std::unique_ptr<const CausticEstimator> build_pass(const Scene& scene,
                                                   const PhotonMapParams& params,
                                                   const RunOptions& options, int pass);

/// The map of pass 0. Phases "trace" (or "load"), "save", "balance" and, with discs of the photons' own, "widths".
/// Counters: those of LightPathCounts, `tree_depth` and `nodes_passed` of the unbalanced tree, `gathers`,
/// `gathered_photons`, `nodes_visited` of the balanced and the unbalanced tree and, where
/// adaptive, the `used_photons` among them; flux is divided by photons_emitted x photons_stored /
/// (photons_stored + photons_dropped), see scene_photons.h. Throws InputError for params that
/// contradict each other and for a file whose photons are those of another scene, UnsupportedScene
/// when the photons asked for cannot be had; with `emitted` an empty map is an answer, and black.
std::unique_ptr<const CausticEstimator> build(const Scene& scene, const PhotonMapParams& params,
                                              const RunOptions& options);

}  // namespace caustics::photonmap

#pragma once

#include <vector>

#include "photonmap/photons/photon_map_params.h"
#include "photonmap/photons/photon_tracing.h"

namespace caustics::photonmap {

/// Tells whether tracing first asks if enough photons arrive (require_yield). The answer for one pass holds for all.
enum class AskYield { yes, no };

/// Traces the photons of a scene that `params` ask for. Counts stay exact and flux unbiased:
///
/// - `emitted`: so many paths, each of them counts. Stratified, the first of them are the largest
///   whole batch (EvenPaths), the few that are left over are random; all weigh the same, so
///   the mean over them is unbiased.
/// - `photons`, random emission and roulette: inverse binomial sampling (trace_photons).
/// - `photons` otherwise: stratified paths depend on each other and a split path brings several photons, so
///   that stopping at a photon would be biased. The number of paths is therefore fixed beforehand,
///   from a pilot with random numbers of its own, such that enough photons come but for one map in
///   thousands; those beyond are dropped at random (drop_photons), and the power's divisor follows.
///   Should too few come, all is traced again with a tenth more paths. That choice looks at the
///   photons; it happens so seldom that its bias is below 1e-5.
///
/// Throws as trace_photons; UnsupportedScene also when no light shines on a caster and photons are
/// asked for. `traced` gets every ray of the final paths, for measuring with one thread.
TracedPhotons trace_scene(const Scene& scene, const PhotonMapParams& params,
                          const RunOptions& options, AskYield ask = AskYield::yes,
                          std::vector<Ray>* traced = nullptr);

}  // namespace caustics::photonmap

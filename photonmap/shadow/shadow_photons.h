#pragma once

#include "core/run_options.h"
#include "core/scene/scene.h"
#include "photonmap/photons/photon_store.h"

namespace caustics::photonmap {

/// What a shadow photon's energy holds.
enum class Lit : std::uint32_t { no, yes };
Lit lit(std::uint32_t energy);

/// Sends `paths` rays of one light through the scene, straight on through everything [C11]: on every receiver
/// that faces them they leave a photon, lit where they come to it first, else in shadow.
PhotonStore trace_shadows(const Scene& scene, std::uint32_t light, std::uint64_t paths,
                          const RunOptions& options);

}  // namespace caustics::photonmap

#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/caustic_estimator.h"
#include "core/light_path.h"
#include "photonmap/photon_store.h"

namespace caustics {

/// How far to trace: exactly one of `stored` and `emitted` is not 0.
struct PhotonTarget {
    std::uint64_t stored = 0;   ///< photons wanted in the map
    std::uint64_t emitted = 0;  ///< paths to trace
    /// Tracing for `stored` gives up when, after this many paths, fewer than one in 2,000 stored.
    std::uint64_t patience = 50'000'000;
};

/// Follows path number `path` and tells where it ends on a receiver; counts all but `emitted` and
/// `stored`. Called from several threads; must depend on the number alone.
using TracePath =
    std::function<std::optional<Deposit>(std::uint64_t path, LightPathCounts& counts)>;

struct TracedPhotons {
    PhotonStore store;
    LightPathCounts counts;
    /// Flux [W] of a photon, per channel, for an energy of 1.
    Spectrum flux_unit;
};

/// Traces paths 0, 1, 2, ... and stores their photons in that order, whatever the number of
/// threads. The photons' energies are relative to `path_flux`, the typical flux of a deposit
/// [W x emitted]: so codes neither over- nor underflow, and a light's colour costs no precision.
///
/// With `target.stored` = n the counted paths are all those before the one that would have stored
/// photon n + 1. Dividing by their number is unbiased: by inverse binomial sampling [Haldane 1945]
/// n / (M - 1) estimates the success rate without bias when the (n+1)-th success is trial M. The
/// number of paths up to the n-th success would read high by n / (n-1).
///
/// Throws UnsupportedScene when `target.stored` cannot be reached, std::runtime_error naming the
/// path for a photon that is not finite.
TracedPhotons trace_photons(const TracePath& trace_path, const Spectrum& path_flux,
                            const PhotonTarget& target, const RunOptions& options);

}  // namespace caustics

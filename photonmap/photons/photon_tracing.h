#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/light_path/light_path.h"
#include "photonmap/photons/photon_store.h"

namespace caustics::photonmap {

/// How far to trace: exactly one of `stored` and `emitted` is not 0.
struct PhotonTarget {
    std::uint64_t stored = 0;    ///< photons wanted in the map
    std::uint64_t emitted = 0;   ///< paths to trace
    std::uint64_t capacity = 0;  ///< the most photons that may come
    std::uint64_t certain = 0;   ///< photons that surely come
};

/// What a run of consecutive paths brought.
class PhotonChunk {
public:
    /// Photons' energies are flux x `energy_per_flux`, rounded at random (encode_rgbe) by the far end
    /// of the path's own random numbers.
    PhotonChunk(const Spectrum& energy_per_flux, std::uint64_t seed)
        : energy_per_flux_(energy_per_flux), seed_(seed) {}

    /// Stores a deposit; those of a path follow each other. Throws std::runtime_error naming the
    /// path when it is not finite.
    void add(std::uint64_t path, const Deposit& deposit);
    void clear();
    std::span<const Photon> photons() const { return photons_; }

    LightPathCounts counts;         ///< `stored` is the number of photons
    std::vector<Deposit> deposits;  ///< scratch of a path tracer

private:
    std::array<double, 3> chance(std::uint64_t path);

    Spectrum energy_per_flux_;
    std::uint64_t seed_;
    std::optional<std::uint64_t> last_path_;
    std::uint32_t deposits_of_path_ = 0;
    std::vector<Photon> photons_;
};

/// Follows light paths, by number.
class PathTracer {
public:
    PathTracer() = default;
    virtual ~PathTracer() = default;
    PathTracer(const PathTracer&) = delete;
    PathTracer& operator=(const PathTracer&) = delete;

    /// Follows the paths first, ..., last - 1 in their order and adds what they bring and count.
    /// Called from several threads; what a path brings depends on its number alone.
    virtual void trace(std::uint64_t first, std::uint64_t last, PhotonChunk& chunk) const = 0;
};

struct TracedPhotons {
    PhotonStore store;
    LightPathCounts counts;
    /// Flux [W x emitted] of a photon, per channel, for an energy of 1.
    Spectrum flux_unit;

    /// Flux [W] of a photon, per channel, for an energy of 1: divided by the emitted paths, and
    /// grown by what the dropped photons carried.
    Spectrum flux_per_energy() const;
};

/// Traces paths 0, 1, 2, ... and stores their photons in that order, whatever the number of
/// threads. The photons' energies are relative to `path_flux`, the typical flux of a deposit
/// [W x emitted]: so codes neither over- nor underflow, and a light's colour costs no precision.
///
/// With `target.stored` = n, which takes paths that bring one photon at most, the counted paths are
/// all those before the one that would have stored photon n + 1. Dividing by their number is
/// unbiased: by inverse binomial sampling [Haldane 1945] n / (M - 1) estimates the success rate
/// without bias when the (n+1)-th success is trial M. The number of paths up to the n-th success
/// would read high by n / (n-1).
///
/// Goes on until `target.stored` are there: ask require_yield() before. Throws InputError for more photons than
/// the capacity, std::runtime_error naming the path for a photon that is not finite.
TracedPhotons trace_photons(const PathTracer& tracer, const Spectrum& path_flux,
                            const PhotonTarget& target, const RunOptions& options);

/// Leaves `wanted` photons, every set of them equally likely, by random numbers of their own; the
/// last photons move to where others were dropped. With a number of paths chosen beforehand this
/// keeps the flux unbiased (TracedPhotons::flux_per_energy), which stopping at the last wanted
/// photon of a stratified or splitting emission would not. Needs at least `wanted` photons.
void drop_photons(TracedPhotons& photons, std::uint64_t wanted, std::uint64_t seed);

}  // namespace caustics::photonmap

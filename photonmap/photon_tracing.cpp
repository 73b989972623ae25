#include "photonmap/photon_tracing.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace caustics {

namespace {

constexpr std::uint64_t smallest_chunk = 64;
constexpr std::uint64_t largest_chunk = 4096;
constexpr std::uint64_t chunks_per_thread = 4;
/// A tree's indices have 32 bits, its node numbers' children one more.
constexpr std::uint64_t most_photons = 2'000'000'000;

/// A run of consecutive paths and what they stored.
struct Chunk {
    std::vector<Photon> photons;
    LightPathCounts counts;
};

[[noreturn]] void fail_not_finite(std::uint64_t path, const Deposit& deposit) {
    std::ostringstream message;
    message << "photonmap: path " << path << " ends with a photon that is not finite: position "
            << deposit.position.transpose() << ", direction " << deposit.wi.transpose() << ", flux "
            << deposit.flux.transpose();
    throw std::runtime_error(message.str());
}

[[noreturn]] void give_up(const LightPathCounts& counts, std::uint64_t wanted) {
    std::ostringstream message;
    message << "photonmap: " << counts.emitted << " light paths stored only " << counts.stored
            << " of " << wanted << " photons: " << counts.emitted - counts.aimed
            << " thinned out at the light, " << counts.missed << " met no caster first, "
            << counts.escaped << " left the scene, " << counts.absorbed << " absorbed, "
            << counts.depth_limited
            << " cut at max_bounces (give `emitted` instead of `photons` to accept few or none)";
    throw UnsupportedScene(message.str());
}

Photon make_photon(std::uint64_t path, const Deposit& deposit, const Spectrum& energy_per_flux) {
    if (!deposit.position.allFinite() || !deposit.wi.allFinite() || !is_finite(deposit.flux) ||
        (deposit.flux < 0).any())
        fail_not_finite(path, deposit);
    const DirectionCode wi = encode_direction(deposit.wi);
    const Vec3& x = deposit.position;
    return {
        {x.x(), x.y(), x.z()}, encode_rgbe(deposit.flux * energy_per_flux), wi.theta, wi.phi, 0};
}

class PhotonTracing {
public:
    PhotonTracing(const TracePath& trace_path, const Spectrum& flux_of_one,
                  const PhotonTarget& target, const RunOptions& options)
        : trace_path_(trace_path),
          energy_per_flux_((flux_of_one > 0).select(flux_of_one.inverse(), 1.0F)),
          target_(target),
          options_(options),
          last_path_(target.stored > 0 ? std::numeric_limits<std::uint64_t>::max()
                                       : target.emitted),
          store_(std::min(most_photons, std::max(target.stored, target.emitted))) {}

    TracedPhotons run() {
        std::uint64_t chunk_paths = smallest_chunk;
        while (!done_) {
            trace_round(chunk_paths);
            chunk_paths = std::min(largest_chunk, 2 * chunk_paths);
            options_.report(share_done());
            if (!done_ && target_.stored > 0 && counts_.emitted >= target_.patience &&
                counts_.stored < counts_.emitted / 2000)
                give_up(counts_, target_.stored);
        }
        return {std::move(store_), counts_, energy_per_flux_.inverse()};
    }

private:
    /// Traces some chunks side by side, then takes them over in their order.
    void trace_round(std::uint64_t chunk_paths) {
        const auto threads = static_cast<std::uint64_t>(std::max(1, options_.threads));
        std::vector<Chunk> chunks(threads * chunks_per_thread);
        const auto first_path = [&](std::size_t chunk) {
            return counts_.emitted + std::min(chunk * chunk_paths, last_path_ - counts_.emitted);
        };
        const std::uint64_t round_end = first_path(chunks.size());
        std::vector<std::uint64_t> starts(chunks.size() + 1, round_end);
        for (std::size_t i = 0; i < chunks.size(); ++i) starts[i] = first_path(i);
        parallel_for(static_cast<int>(threads), chunks.size(), [&](std::size_t i, std::size_t) {
            chunks[i] = trace_chunk(starts[i], starts[i + 1], most_photons);
        });
        for (std::size_t i = 0; i < chunks.size() && !done_; ++i)
            take(std::move(chunks[i]), starts[i], starts[i + 1]);
        if (counts_.emitted == last_path_) done_ = true;
    }

    /// Traces paths begin..end, but stops before the path that would store photon `limit` + 1.
    Chunk trace_chunk(std::uint64_t begin, std::uint64_t end, std::uint64_t limit) const {
        Chunk chunk;
        for (std::uint64_t path = begin; path < end; ++path) {
            LightPathCounts counts;
            const std::optional<Deposit> deposit = trace_path_(path, counts);
            if (deposit && chunk.photons.size() == limit) break;
            counts.emitted = 1;
            counts.stored = deposit ? 1 : 0;
            chunk.counts.add(counts);
            if (deposit) chunk.photons.push_back(make_photon(path, *deposit, energy_per_flux_));
        }
        return chunk;
    }

    void take(Chunk chunk, std::uint64_t begin, std::uint64_t end) {
        if (target_.stored > 0) {
            const std::uint64_t missing = target_.stored - counts_.stored;
            done_ = chunk.photons.size() > missing;
            if (done_) chunk = trace_chunk(begin, end, missing);
        }
        store_.append(chunk.photons);
        counts_.add(chunk.counts);
    }

    double share_done() const {
        if (done_) return 1;
        const auto share = [](std::uint64_t part, std::uint64_t whole) {
            return static_cast<double>(part) / static_cast<double>(whole);
        };
        return target_.stored > 0 ? share(counts_.stored, target_.stored)
                                  : share(counts_.emitted, target_.emitted);
    }

    const TracePath& trace_path_;
    Spectrum energy_per_flux_;
    PhotonTarget target_;
    const RunOptions& options_;
    std::uint64_t last_path_;
    PhotonStore store_;
    LightPathCounts counts_;
    bool done_ = false;
};

}  // namespace

TracedPhotons trace_photons(const TracePath& trace_path, const Spectrum& path_flux,
                            const PhotonTarget& target, const RunOptions& options) {
    // The typical photon gets the largest mantissa, where rounding is finest.
    const Spectrum flux_of_one = path_flux * (256.0F / 255.0F);
    return PhotonTracing(trace_path, flux_of_one, target, options).run();
}

}  // namespace caustics

#include "photonmap/photons/photon_tracing.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "photonmap/photons/facing_code.h"

namespace caustics::photonmap {

namespace {

constexpr std::uint64_t smallest_chunk = 64;
constexpr int chunk_doublings = 6;
constexpr std::uint64_t largest_chunk = smallest_chunk << chunk_doublings;
/// How many chunks may wait for a slow one before them: bounds the scratch memory.
constexpr std::uint64_t chunks_ahead_per_thread = 3;
constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

[[noreturn]] void fail_not_finite(std::uint64_t path, const Deposit& deposit) {
    std::ostringstream message;
    message << "photonmap: path " << path << " ends with a photon that is not finite: position "
            << deposit.position.transpose() << ", direction " << deposit.wi.transpose() << ", flux "
            << deposit.flux.transpose();
    throw std::runtime_error(message.str());
}

/// The first path of a chunk: chunks double up to the largest.
std::uint64_t chunk_start(std::uint64_t chunk) {
    const auto doubling = std::min<std::uint64_t>(chunk, chunk_doublings);
    return smallest_chunk * ((std::uint64_t{1} << doubling) - 1) +
           (chunk - doubling) * largest_chunk;
}

/// Threads trace chunks of paths side by side, each into scratch of its own; a finished chunk gets
/// its place in the store as soon as all chunks before it have theirs, and is written there
/// outside the lock. Nobody waits for the others but to keep the scratch small.
class PhotonTracing {
public:
    PhotonTracing(const PathTracer& tracer, const Spectrum& flux_of_one, const PhotonTarget& target,
                  const RunOptions& options)
        : tracer_(tracer),
          energy_per_flux_((flux_of_one > 0).select(flux_of_one.inverse(), 1.0F)),
          target_(target),
          options_(options),
          last_path_(target.stored > 0 ? unlimited : target.emitted),
          threads_(static_cast<std::uint64_t>(std::max(1, options.threads))),
          store_(target.capacity, target.certain) {}

    TracedPhotons run() {
        parallel_for(static_cast<int>(threads_), threads_,
                     [this](std::size_t, std::size_t) { work(); });
        store_.settle();
        return {std::move(store_), counts_, energy_per_flux_.inverse()};
    }

private:
    using Scratch = std::unique_ptr<PhotonChunk>;
    /// A chunk that has its place in the store but is not written there yet.
    struct Placed {
        Scratch scratch;
        std::span<Photon> place;
    };

    void work() {
        try {
            for (;;) {
                const std::uint64_t chunk = next_chunk_++;
                Scratch scratch = wait_for_turn(chunk);
                if (!scratch) return;
                tracer_.trace(chunk_start(chunk), std::min(chunk_start(chunk + 1), last_path_),
                              *scratch);
                for (Placed& placed : finish(chunk, std::move(scratch))) {
                    const auto photons = placed.scratch->photons().first(placed.place.size());
                    std::ranges::copy(photons, placed.place.begin());
                    const std::lock_guard lock(mutex_);
                    spare_.push_back(std::move(placed.scratch));
                }
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            done_ = true;
            turn_.notify_all();
            throw;
        }
    }

    /// Scratch to trace the chunk into, or none when it is not wanted any more; waits while the
    /// chunk is too far ahead of the others.
    Scratch wait_for_turn(std::uint64_t chunk) {
        if (chunk_start(chunk) >= last_path_) return {};
        std::unique_lock lock(mutex_);
        turn_.wait(lock, [&] {
            return done_ || chunk < placed_chunks_ + threads_ * (1 + chunks_ahead_per_thread);
        });
        if (done_) return {};
        if (spare_.empty()) return std::make_unique<PhotonChunk>(energy_per_flux_, options_.seed);
        Scratch scratch = std::move(spare_.back());
        spare_.pop_back();
        scratch->clear();
        return scratch;
    }

    /// Takes a traced chunk over, and gives places to all whose turn has come.
    std::vector<Placed> finish(std::uint64_t chunk, Scratch scratch) {
        std::vector<Placed> placed;
        const std::lock_guard lock(mutex_);
        traced_.emplace(chunk, std::move(scratch));
        while (!done_ && !traced_.empty() && traced_.begin()->first == placed_chunks_) {
            Scratch first = std::move(traced_.begin()->second);
            traced_.erase(traced_.begin());
            const std::span<Photon> place = take(*first);
            ++placed_chunks_;
            placed.push_back({std::move(first), place});
            options_.report(share_done());
        }
        turn_.notify_all();
        return placed;
    }

    /// Counts a chunk in its turn and reserves its place.
    std::span<Photon> take(PhotonChunk& chunk) {
        const std::uint64_t begin = chunk_start(placed_chunks_);
        const std::uint64_t end = std::min(chunk_start(placed_chunks_ + 1), last_path_);
        if (target_.stored > 0 && chunk.counts.stored > target_.stored - counts_.stored) {
            done_ = true;
            chunk.counts = counts_up_to(begin, target_.stored - counts_.stored);
        }
        counts_.add(chunk.counts);
        if (end == last_path_) done_ = true;
        return store_.extend(chunk.counts.stored);
    }

    /// Counts of the paths from `path` on, before the one that would store photon `limit` + 1.
    LightPathCounts counts_up_to(std::uint64_t path, std::uint64_t limit) const {
        LightPathCounts sum;
        PhotonChunk one(energy_per_flux_, options_.seed);
        for (;; ++path) {
            one.clear();
            tracer_.trace(path, path + 1, one);
            if (sum.stored + one.counts.stored > limit) return sum;
            sum.add(one.counts);
        }
    }

    double share_done() const {
        if (done_) return 1;
        const auto share = [](std::uint64_t part, std::uint64_t whole) {
            return static_cast<double>(part) / static_cast<double>(whole);
        };
        return target_.stored > 0 ? share(counts_.stored, target_.stored)
                                  : share(counts_.emitted, target_.emitted);
    }

    const PathTracer& tracer_;
    Spectrum energy_per_flux_;
    PhotonTarget target_;
    const RunOptions& options_;
    std::uint64_t last_path_;
    std::uint64_t threads_;

    std::atomic<std::uint64_t> next_chunk_{0};
    std::mutex mutex_;  ///< of all below
    std::condition_variable turn_;
    std::map<std::uint64_t, Scratch> traced_;  ///< chunks that wait for their turn
    std::vector<Scratch> spare_;
    std::uint64_t placed_chunks_ = 0;
    PhotonStore store_;
    LightPathCounts counts_;
    bool done_ = false;
};

/// Uniform below `bound`, without the remainder's bias [Lemire 2019].
std::uint64_t uniform_below(std::uint64_t bound, Rng& rng) {
    const auto range = static_cast<std::uint32_t>(bound);
    const std::uint32_t rejected = (0U - range) % range;
    for (;;) {
        const std::uint64_t product = std::uint64_t{rng.next_word()} * range;
        if (static_cast<std::uint32_t>(product) >= rejected) return product >> 32U;
    }
}

}  // namespace

void PhotonChunk::clear() {
    counts = {};
    last_path_.reset();
    photons_.clear();
}

std::array<double, 3> PhotonChunk::chance(std::uint64_t path) {
    deposits_of_path_ = path == last_path_ ? deposits_of_path_ + 1 : 0;
    last_path_ = path;
    // No path draws so many numbers that it comes here.
    const std::uint32_t dimension = ~deposits_of_path_;
    const auto words =
        philox4x32({dimension, static_cast<std::uint32_t>(Stage::photons),
                    static_cast<std::uint32_t>(path), static_cast<std::uint32_t>(path >> 32U)},
                   {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32U)});
    return {words[0] * 0x1p-32, words[1] * 0x1p-32, words[2] * 0x1p-32};
}

void PhotonChunk::add(std::uint64_t path, const Deposit& deposit) {
    const Vec3& x = deposit.position;
    const Spectrum& flux = deposit.flux;
    // What is not finite makes the sum's difference to itself not a number.
    const float sum = x.sum() + deposit.wi.sum() + flux.sum();
    const bool fine =
        sum - sum == 0 || (x.allFinite() && deposit.wi.allFinite() && is_finite(flux));
    if (!fine || !(flux.minCoeff() >= 0)) fail_not_finite(path, deposit);
    const DirectionCode wi = encode_direction(deposit.wi);
    const Vec3& n = deposit.geometric_normal;
    photons_.push_back({{x.x(), x.y(), x.z()},
                        encode_rgbe(flux * energy_per_flux_, chance(path)),
                        wi.theta,
                        wi.phi,
                        facing_flags({n.x(), n.y(), n.z()})});
    if (deposit.diffuse_bounces > 0) photons_.back().flags |= from_diffuse_mark;
}

Spectrum TracedPhotons::flux_per_energy() const {
    if (counts.emitted == 0 || counts.stored == 0) return flux_unit;
    const double kept =
        static_cast<double>(counts.stored) / static_cast<double>(counts.stored + counts.dropped);
    return flux_unit / static_cast<float>(static_cast<double>(counts.emitted) * kept);
}

TracedPhotons trace_photons(const PathTracer& tracer, const Spectrum& path_flux,
                            const PhotonTarget& target, const RunOptions& options) {
    // The typical photon gets the largest mantissa, where rounding is finest.
    const Spectrum flux_of_one = path_flux * (256.0F / 255.0F);
    return PhotonTracing(tracer, flux_of_one, target, options).run();
}

void drop_photons(TracedPhotons& photons, std::uint64_t wanted, std::uint64_t seed) {
    const std::span<Photon> all = photons.store.photons();
    Rng rng(seed, Stage::photon_choice, 0);
    // Each round drops one of those left: the last steps of a shuffle [Fisher and Yates 1938].
    for (std::uint64_t left = all.size(); left > wanted; --left)
        all[uniform_below(left, rng)] = all[left - 1];
    photons.counts.dropped += all.size() - wanted;
    photons.counts.stored = wanted;
    photons.store.shrink(wanted);
}

}  // namespace caustics::photonmap

#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/interrupt.h"
#include "core/base/parallel.h"
#include "core/light_path/aimed_emission.h"
#include "core/light_path/even_paths.h"
#include "core/light_path/light_path.h"
#include "core/light_path/whole_path.h"

namespace caustics {

/// Light paths first, first + 1, ..., first + paths - 1 of a scene.
struct OrderedPaths {
    const Scene& scene;
    const AimedEmission& emission;
    std::uint64_t paths;
    int max_bounces;
    std::uint64_t seed;
    Stage stage;  ///< of their random numbers
    /// Where given: of all events; what is left after a diffuse reflection counts.
    std::optional<WholePathSettings> whole = {};
    std::uint64_t first = 0;
    /// Where given, a batch of as many as there are paths; they start side by side and are followed in packets.
    /// Not of whole paths.
    std::optional<EvenPaths> even = {};
    std::optional<double> wavelength_shift = {};  ///< LightPathSettings

    static constexpr std::uint64_t chunk = 4096;
    static constexpr std::uint64_t chunks_per_round = 256;

    /// Follows the paths of a chunk and calls sink(deposit, path) for what arrives, path by path.
    template <typename Sink>
    void trace_chunk(std::uint64_t index, LightPathCounts& counts, const Sink& sink) const {
        const std::uint64_t begin = first + index * chunk;
        const std::uint64_t end = std::min(begin + chunk, first + paths);
        if (even)
            trace_together(begin, end, counts, sink);
        else
            trace_one_by_one(begin, end, counts, sink);
    }

private:
    template <typename Sink>
    void trace_one_by_one(std::uint64_t begin, std::uint64_t end, LightPathCounts& counts,
                          const Sink& sink) const {
        std::vector<Deposit> deposits;
        for (std::uint64_t path = begin; path < end; ++path) {
            throw_if_interrupted();
            Rng rng(seed, stage, path);
            ++counts.emitted;
            const std::optional<LightParticle> particle = emission.emit(rng);
            if (!particle) continue;
            ++counts.aimed;
            deposits.clear();
            if (whole)
                trace_whole_path(scene, *particle, *whole, rng, counts, deposits);
            else
                trace_light_path(scene, *particle, {max_bounces}, rng, counts, deposits);
            for (const Deposit& deposit : deposits)
                if (!whole || deposit.diffuse_bounces > 0) sink(deposit, path);
        }
    }

    // Neighbours in a square start side by side.
    template <typename Sink>
    void trace_together(std::uint64_t begin, std::uint64_t end, LightPathCounts& counts,
                        const Sink& sink) const {
        const LightPathSettings settings{.max_bounces = max_bounces,
                                         .wavelength_shift = wavelength_shift};
        EmissionSamples samples;
        std::vector<LightPathStart> starts;
        std::vector<DepositOfMany> deposits;
        for (; begin < end; begin += samples.size()) {
            throw_if_interrupted();
            const std::size_t count = std::min<std::uint64_t>(end - begin, EmissionSamples::most);
            even->draw({seed, static_cast<std::uint32_t>(stage), begin, count}, first,
                       emission.kernels(), samples);
            starts.clear();
            deposits.clear();
            emission.emit(samples, starts);
            counts.emitted += count;
            counts.aimed += starts.size();
            trace_light_paths(scene, starts, settings, counts, deposits);
            for (const DepositOfMany& one : deposits) sink(one.deposit, begin + one.start);
        }
    }
};

/// Traces all paths by any thread: `collect(deposit, path, arrivals)` appends to a vector of `Arrival` what a
/// deposit brings, side by side; `take(arrival)` gets them one by one in the order of the paths, so
/// that sums are the same for any number of threads.
template <typename Arrival, typename Collect, typename Take>
LightPathCounts trace_in_order(const OrderedPaths& work, const RunOptions& options,
                               const Collect& collect, const Take& take) {
    constexpr std::uint64_t per_round = OrderedPaths::chunks_per_round;
    const std::uint64_t chunks = (work.paths + OrderedPaths::chunk - 1) / OrderedPaths::chunk;
    std::vector<std::vector<Arrival>> arrivals(per_round);
    std::vector<LightPathCounts> counts(per_round);
    LightPathCounts total;
    for (std::uint64_t first = 0; first < chunks; first += per_round) {
        const std::uint64_t in_round = std::min(per_round, chunks - first);
        parallel_for(options.threads, in_round, [&](std::size_t i, std::size_t) {
            arrivals[i].clear();
            counts[i] = {};
            work.trace_chunk(first + i, counts[i], [&](const Deposit& d, std::uint64_t path) {
                collect(d, path, arrivals[i]);
            });
        });
        for (std::size_t i = 0; i < in_round; ++i) {
            for (const Arrival& arrival : arrivals[i]) take(arrival);
            total.add(counts[i]);
        }
        options.report(static_cast<double>(first + in_round) / static_cast<double>(chunks));
    }
    return total;
}

}  // namespace caustics

#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/interrupt.h"
#include "core/base/parallel.h"
#include "core/light_path/aimed_emission.h"
#include "core/light_path/light_path.h"
#include "core/light_path/whole_path.h"

namespace caustics {

/// Light paths 0, 1, ..., paths - 1 of a scene.
struct OrderedPaths {
    const Scene& scene;
    const AimedEmission& emission;
    std::uint64_t paths;
    int max_bounces;
    std::uint64_t seed;
    Stage stage;  ///< of their random numbers
    /// Where given: of all events; what is left after a diffuse reflection counts.
    std::optional<WholePathSettings> whole = {};

    static constexpr std::uint64_t chunk = 4096;
    static constexpr std::uint64_t chunks_per_round = 256;

    /// Follows the paths of a chunk and calls sink(deposit) for what arrives.
    template <typename Sink>
    void trace_chunk(std::uint64_t index, LightPathCounts& counts, const Sink& sink) const {
        const std::uint64_t end = std::min((index + 1) * chunk, paths);
        std::vector<Deposit> deposits;
        for (std::uint64_t path = index * chunk; path < end; ++path) {
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
                if (!whole || deposit.diffuse_bounces > 0) sink(deposit);
        }
    }
};

/// Traces all paths by any thread: `collect(deposit, arrivals)` appends to a vector of `Arrival` what a
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
            work.trace_chunk(first + i, counts[i],
                             [&](const Deposit& d) { collect(d, arrivals[i]); });
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

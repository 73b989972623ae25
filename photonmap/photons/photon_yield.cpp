#include "photonmap/photons/photon_yield.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace caustics::photonmap {

namespace {

constexpr std::uint64_t first_pilot_paths = 4096;
constexpr std::uint64_t most_pilot_paths = 2'000'000;
constexpr std::uint64_t enough_photons = 400;  ///< photons: their rate is known to 5 %
constexpr std::uint64_t fewest_photons = 16;   ///< photons of most_pilot_paths
constexpr double lowest_rate = 1.0 / 2000;
constexpr double most_patience = 50'000'000;  ///< paths, below the lowest rate

LightPathCounts counts_of_pilot(const PathTracer& paths, const Spectrum& path_flux) {
    PhotonChunk chunk(Spectrum::Ones() / path_flux.maxCoeff(), seed_of_yield);
    for (std::uint64_t done = 0, next = first_pilot_paths; done < most_pilot_paths;
         done = next, next *= 2) {
        paths.trace(done, std::min(next, most_pilot_paths), chunk);
        if (chunk.counts.stored >= enough_photons) break;
    }
    return chunk.counts;
}

std::string advice(const std::string& text) { return text.empty() ? text : " (" + text + ")"; }

}  // namespace

void require_yield(const PathTracer& paths, const WantedPhotons& wanted) {
    const LightPathCounts counts = counts_of_pilot(paths, wanted.path_flux);
    if (counts.stored == 0)
        throw UnsupportedScene(fmt::format("{}: no photon can be stored: {}{}", wanted.method,
                                           wanted.why_none(counts),
                                           advice(wanted.when_hardly_any)));
    if (counts.stored < fewest_photons)
        throw UnsupportedScene(fmt::format(
            "{}: {} light paths stored only {} photon{}, too few to tell how many more it "
            "takes: {}{}",
            wanted.method, counts.emitted, counts.stored, counts.stored == 1 ? "" : "s",
            ends_of(counts), advice(wanted.when_hardly_any)));
    const double rate = static_cast<double>(counts.stored) / static_cast<double>(counts.emitted);
    const double needed = static_cast<double>(wanted.count) / rate;
    if (rate >= lowest_rate || needed < most_patience) return;
    throw UnsupportedScene(
        fmt::format("{}: {} light paths stored only {} of {} photons, which would take some {:.1g} "
                    "light paths: {}{}",
                    wanted.method, counts.emitted, counts.stored, wanted.count, needed,
                    ends_of(counts), advice(wanted.otherwise)));
}

}  // namespace caustics::photonmap

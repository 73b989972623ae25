#include "photonmap/photons/global_photons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/light_path/aimed_emission.h"
#include "core/light_path/whole_path.h"
#include "photonmap/photons/photon_yield.h"

namespace caustics::photonmap {
namespace {

class GlobalPaths final : public PathTracer {
public:
    GlobalPaths(const Scene& scene, const AimedEmission& emission,
                const WholePathSettings& settings, std::uint64_t seed, Stage stage)
        : scene_(scene), emission_(emission), settings_(settings), seed_(seed), stage_(stage) {}

    void trace(std::uint64_t first, std::uint64_t last, PhotonChunk& chunk) const override {
        chunk.counts.emitted += last - first;
        for (; first < last; ++first) {
            Rng rng(seed_, stage_, first);
            const auto particle = emission_.emit(rng);
            if (!particle) continue;
            ++chunk.counts.aimed;
            chunk.deposits.clear();
            trace_whole_path(scene_, *particle, settings_, rng, chunk.counts, chunk.deposits);
            for (const Deposit& deposit : chunk.deposits) chunk.add(first, deposit);
        }
    }

private:
    const Scene& scene_;
    const AimedEmission& emission_;
    WholePathSettings settings_;
    std::uint64_t seed_;
    Stage stage_;
};

// Photons a path, by a pilot of its own random numbers.
double photons_per_path(const GlobalPaths& pilot, const Spectrum& power, std::uint64_t seed) {
    constexpr std::uint64_t enough = 1000;
    constexpr std::uint64_t most = 1'000'000;
    PhotonChunk chunk(Spectrum::Ones() / power.maxCoeff(), seed);
    for (std::uint64_t paths = 4096, done = 0; done < most || chunk.counts.stored == 0;
         done = paths, paths *= 4) {
        pilot.trace(done, paths, chunk);
        if (chunk.counts.stored >= enough) break;
    }
    return static_cast<double>(chunk.counts.stored) / static_cast<double>(chunk.counts.emitted);
}

}  // namespace

TracedPhotons trace_global(const Scene& scene, const GlobalMapParams& params,
                           const RunOptions& options) {
    const AimedEmission emission(scene, options.isa, Aim::everywhere);
    if (emission.empty())
        throw UnsupportedScene("globalphotonmap: no photon can be stored: the scene has no light");
    const WholePathSettings settings{params.max_bounces, params.diffuse_bounces};
    const auto paths_of = [&](Stage stage, std::uint64_t seed) {
        return GlobalPaths(scene, emission, settings, seed, stage);
    };
    require_yield(paths_of(Stage::global_pilot, seed_of_yield),
                  {.count = params.photons,
                   .path_flux = emission.total_power(),
                   .method = "globalphotonmap",
                   .otherwise = "ask for fewer `photons`",
                   .when_hardly_any = {},
                   .why_none = [](const LightPathCounts& counts) -> std::string {
                       return fmt::format("no light fell on a diffuse surface in {} light paths",
                                          counts.emitted);
                   }});
    const double yield = photons_per_path(paths_of(Stage::global_pilot, options.seed),
                                          emission.total_power(), options.seed);
    const auto wanted = static_cast<double>(params.photons);
    for (double paths = (wanted * 1.05 + 100 * std::sqrt(wanted)) / yield;; paths *= 1.1) {
        const PhotonTarget target{.emitted = static_cast<std::uint64_t>(std::ceil(paths)),
                                  .capacity = 4 * params.photons + 10'000'000,
                                  .certain = params.photons};
        TracedPhotons photons = trace_photons(paths_of(Stage::global_photons, options.seed),
                                              emission.total_power(), target, options);
        if (photons.store.size() < params.photons) continue;
        drop_photons(photons, params.photons, options.seed);
        return photons;
    }
}

PhotonStore take_indirect(PhotonStore& photons) {
    const auto is_marked = [](const Photon& photon) {
        return (photon.flags & from_diffuse_mark) != 0;
    };
    PhotonStore taken(
        static_cast<std::uint64_t>(std::ranges::count_if(photons.photons(), is_marked)));
    for (Photon& photon : photons.photons()) {
        if (!is_marked(photon)) continue;
        photon.flags = static_cast<std::uint16_t>(photon.flags & ~unsigned{from_diffuse_mark});
        taken.append({&photon, 1});
    }
    return taken;
}

}  // namespace caustics::photonmap

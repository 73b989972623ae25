#include "experiments/cli/map_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/hash.h"
#include "core/render/renderer.h"
#include "photonmap/photon_dots.h"

namespace caustics::experiments {

namespace {

/// Of white, for the scene behind the photons.
constexpr double dimmed = 0.1;

std::string point(const Vec3& p) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

double mean_of_channels(const Spectrum& s) { return static_cast<double>(s.mean()); }

/// Flux of all photons [W] and the box that holds them.
std::string extent(const photonmap::TracedPhotons& photons) {
    SpectrumSum energy = SpectrumSum::Zero();
    Box box;
    for (const photonmap::Photon& photon : photons.store.photons()) {
        energy += photonmap::decode_rgbe(photon.energy).cast<double>();
        box.extend(photonmap::position(photon));
    }
    const SpectrumSum flux = energy * photons.flux_per_energy().cast<double>();
    std::string text =
        fmt::format("flux       {:.6g} {:.6g} {:.6g} W\n", flux[0], flux[1], flux[2]);
    if (!box.isEmpty())
        text += fmt::format("bounds     {} to {} m, in the scene's frame\n", point(box.min()),
                            point(box.max()));
    return text;
}

std::string whole_paths_line(const photonmap::PhotonOrigin& origin) {
    return fmt::format(
        "traced     between all surfaces (globalphotonmap), max_bounces {}, {}, seed {}\n",
        origin.max_bounces,
        origin.diffuse_bounces == 0 ? "ended by roulette alone"
                                    : fmt::format("ended at receiver {}", origin.diffuse_bounces),
        origin.seed);
}

}  // namespace

std::string describe_map(const std::filesystem::path& file, const photonmap::SavedPhotons& saved) {
    const LightPathCounts& counts = saved.photons.counts;
    const photonmap::PhotonOrigin& origin = saved.origin;
    const bool stratified = origin.emission == photonmap::PhotonMapParams::Emission::stratified;
    std::string text = fmt::format("photon map {}, format version {}, {} bytes\n", file.string(),
                                   saved.version, std::filesystem::file_size(file));
    text += fmt::format("transport  {} (info SCENE shows whether a scene's is the same)\n",
                        hex(origin.transport));
    text += fmt::format("photons    {} stored by {} emitted light paths\n", counts.stored,
                        counts.emitted);
    text += extent(saved.photons);
    text += fmt::format(
        "paths      {} aimed, {} branched, {} times reflected, {} times refracted, {} missed, "
        "{} escaped, {} absorbed, {} misdirected by smooth normals, {} on black sides, "
        "{} cut at max_bounces, {} photons dropped\n",
        counts.aimed, counts.branched, counts.reflected, counts.refracted, counts.missed,
        counts.escaped, counts.absorbed, counts.misdirected, counts.on_black_side,
        counts.depth_limited, counts.dropped);
    if (origin.whole_paths)
        return text + whole_paths_line(origin) + fmt::format("by         {}\n", origin.command);
    text += fmt::format("traced     emission {}, interaction {}, max_bounces {}, seed {}\n",
                        stratified ? "stratified" : "random",
                        origin.interaction == Interaction::split ? "split" : "roulette",
                        origin.max_bounces, origin.seed);
    return text + fmt::format("by         {}\n", origin.command);
}

Picture draw_photons(const Scene& scene, photonmap::TracedPhotons photons, double radius,
                     const RunOptions& options) {
    const auto dots = photonmap::photon_dots(scene, std::move(photons), radius, options.isa);
    const Film film = render(scene, *dots, options).film;
    double brightest = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        brightest = std::max(brightest, mean_of_channels(film.rgb("caustic", i)));
    const double scale = brightest > 0 ? 1 / brightest : 0;
    const double behind = dimmed * std::exp2(auto_exposure(film, "direct"));
    Film drawn(film.width(), film.height());
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        drawn.set_rgb("", i,
                      film.rgb("direct", i) * static_cast<float>(behind) +
                          film.rgb("caustic", i) * static_cast<float>(scale));
    return tone_map(drawn, "", 0);
}

}  // namespace caustics::experiments

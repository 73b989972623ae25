#include "photonmap/shadow/shadow_photons.h"

#include <bit>
#include <utility>

#include "core/light_path/aimed_emission.h"
#include "core/light_path/flight.h"
#include "photonmap/photons/photon_tracing.h"

namespace caustics::photonmap {
namespace {

/// A ray that meets more surfaces ends there.
constexpr int most_surfaces = 64;

class StraightPaths final : public PathTracer {
public:
    StraightPaths(const Scene& scene, std::uint32_t light, const RunOptions& options)
        : scene_(scene),
          emission_(scene, options.isa, Aim::everywhere, light),
          light_(light),
          seed_(options.seed) {}

    void trace(std::uint64_t first, std::uint64_t last, PhotonChunk& chunk) const override {
        chunk.counts.emitted += last - first;
        for (; first < last; ++first) {
            Rng rng(seed_, Stage::shadow_photons, std::uint64_t{light_} << 40U | first);
            const auto particle = emission_.emit(rng);
            if (particle) follow(first, *particle, chunk);
        }
    }

private:
    // Photons in shadow are marked as a global map marks those that come from a diffuse surface.
    void follow(std::uint64_t path, const LightParticle& particle, PhotonChunk& chunk) const {
        Flight flight{particle.ray, Spectrum::Ones()};
        for (int surface = 0; surface < most_surfaces; ++surface) {
            const std::optional<SurfacePoint> hit = scene_.intersect(flight.ray);
            if (!hit) return;
            if (is_receiver(scene_.shape_at(*hit).bsdf))
                if (auto deposit = deposit_of(scene_, *hit, flight)) {
                    deposit->diffuse_bounces = surface > 0 ? 1 : 0;
                    chunk.add(path, *deposit);
                    ++chunk.counts.stored;
                }
            flight.ray = spawn_ray({hit->position, hit->geometric_normal, hit->offset},
                                   flight.ray.direction);
        }
    }

    const Scene& scene_;
    AimedEmission emission_;
    std::uint32_t light_;
    std::uint64_t seed_;
};

}  // namespace

Lit lit(std::uint32_t energy) { return static_cast<Lit>(energy); }

PhotonStore trace_shadows(const Scene& scene, std::uint32_t light, std::uint64_t paths,
                          const RunOptions& options) {
    const StraightPaths tracer(scene, light, options);
    PhotonStore store =
        trace_photons(tracer, Spectrum::Ones(),
                      {.emitted = paths, .capacity = paths * most_surfaces, .certain = 0}, options)
            .store;
    for (Photon& photon : store.photons()) {
        const bool in_shadow = (photon.flags & from_diffuse_mark) != 0;
        photon.flags = static_cast<std::uint16_t>(photon.flags & ~unsigned{from_diffuse_mark});
        photon.energy =
            std::bit_cast<Rgbe>(static_cast<std::uint32_t>(in_shadow ? Lit::no : Lit::yes));
    }
    return store;
}

}  // namespace caustics::photonmap

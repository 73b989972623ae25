#include "core/reference/caustic_sample.h"

#include "core/reference/backward_chain.h"

namespace caustics {
namespace {

// Radiance arriving along a chain from L S+; 0 when its first surface is no caster. Up to the first dielectric the
// chain does not know its medium: that says it, or the light.
Spectrum chain_radiance(const Scene& scene, BackwardChain chain, int max_bounces, Rng& rng) {
    Spectrum result = black();
    float unknown = 0;  // length of the way in a medium that nothing has named yet [m]
    for (;;) {
        const std::optional<SurfacePoint> hit = scene.intersect(chain.ray);
        if (!hit) {
            if (chain.bounces > 0)
                result += chain.weight * scene.background() *
                          scene.transmittance_along(chain.ray, chain.start_absorption);
            return result;
        }
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        const bool is_named = chain.start_absorption != nullptr;
        const Spectrum* const side =
            medium_absorption(bsdf, hit->geometric_normal, -chain.ray.direction);
        if (!is_named && side != nullptr)
            chain.weight *= segment_transmittance(nullptr, side, unknown);
        unknown += hit->distance;
        chain.arrive(*hit, bsdf);
        const AreaLight* light = scene.area_light(hit->shape);
        if (light != nullptr && chain.bounces > 0 &&
            hit->geometric_normal.dot(-chain.ray.direction) > 0)
            result +=
                chain.weight * light->radiance *
                segment_transmittance(is_named ? nullptr : scene.area_light_medium(hit->shape),
                                      nullptr, unknown);
        float chance = 0;
        if (!is_caster(bsdf) || chain.bounces == max_bounces || !chain.survives(rng) ||
            !chain.turn(*hit, bsdf, rng, chance))
            return result;
    }
}

}  // namespace

Spectrum caustic_sample(const Scene& scene, const ReceiverPoint& point,
                        const DirectionMixture& mixture, bool with_bsdf, int max_bounces,
                        Rng& rng) {
    const std::optional<Vec3> wi = mixture.sample(rng);
    if (!wi) return black();
    const float cosine = point.geometric_normal.dot(*wi);
    if (cosine <= 0) return black();
    const Spectrum scattering =
        with_bsdf ? evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, *wi)
                  : Spectrum(Spectrum::Ones());
    if (is_black(scattering)) return black();
    const BackwardChain chain{
        .ray = spawn_ray({point.position, point.geometric_normal, point.offset}, *wi),
        .wavelength = {.nm = point.nm}};
    const float weight = cosine / mixture.pdf_w(*wi);
    return scattering * chain_radiance(scene, chain, max_bounces, rng) * weight;
}

}  // namespace caustics

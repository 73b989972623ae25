#include "core/reference/backward_chain.h"

#include <cmath>

#include "core/light_path/bounce_limit.h"

namespace caustics {
namespace {

float flux_correction(const SurfacePoint& p, const Vec3& towards_receiver,
                      const Vec3& towards_light) {
    const float numerator =
        p.shading_normal.dot(towards_receiver) * p.geometric_normal.dot(towards_light);
    const float denominator =
        p.shading_normal.dot(towards_light) * p.geometric_normal.dot(towards_receiver);
    return denominator == 0 ? 0 : std::abs(numerator / denominator);
}

}  // namespace

void BackwardChain::arrive(const SurfacePoint& hit, const Bsdf& bsdf) {
    weight *= segment_transmittance(start_absorption,
                                    medium_absorption(bsdf, hit.geometric_normal, -ray.direction),
                                    hit.distance);
}

bool BackwardChain::survives(Rng& rng) {
    const float chance = chance_to_go_on(bounces, weight.mean());
    if (chance >= 1) return true;
    if (rng.next() >= chance) return false;
    weight /= chance;
    return true;
}

bool BackwardChain::turn(const SurfacePoint& hit, const Bsdf& bsdf, Rng& rng, float& chance) {
    const Vec3 w = -ray.direction;
    wavelength.arrive_at(bsdf, rng, weight);
    const SpecularSplit split =
        split_specular(bsdf, hit.geometric_normal, hit.shading_normal, w, wavelength.nm);
    const float reflect_share = (split.reflected_weight * weight).mean() / weight.mean();
    const float refract_share = (split.refracted_weight * weight).mean() / weight.mean();
    chance = reflect_share + refract_share;
    const float u = rng.next();
    Vec3 next;
    if (u < reflect_share) {
        next = split.reflected;
        weight *= split.reflected_weight / reflect_share;
    } else if (u < reflect_share + refract_share) {
        next = split.refracted;
        weight *= split.refracted_weight / (refract_share * split.eta * split.eta);
    } else {
        return false;
    }
    weight *= flux_correction(hit, w, next);
    if (weight.maxCoeff() <= 0) return false;
    start_absorption = medium_after(bsdf, hit.geometric_normal, next, start_absorption);
    ray = spawn_ray({hit.position, hit.geometric_normal, hit.offset}, next);
    ++bounces;
    return true;
}

std::optional<WeightedPoint> receiver_ahead(const Scene& scene, BackwardChain& chain,
                                            std::optional<SurfacePoint> hit, int max_bounces,
                                            Rng& rng) {
    for (; hit; hit = scene.intersect(chain.ray)) {
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        chain.arrive(*hit, bsdf);
        if (is_black(chain.weight) || !chain.survives(rng)) return {};
        const Vec3 towards = -chain.ray.direction;
        float specular = 0;
        if (is_caster(bsdf) && chain.bounces < max_bounces) {
            const Spectrum before = chain.weight;
            if (chain.turn(*hit, bsdf, rng, specular)) continue;
            chain.weight = before;
        }
        auto point = receiver_point(scene, *hit, towards);
        if (!point) return {};
        point->nm = chain.wavelength.nm;
        point->medium = chain.start_absorption;
        chain.specular = specular;
        return WeightedPoint{*point, chain.weight / (1 - specular)};
    }
    return {};
}

}  // namespace caustics

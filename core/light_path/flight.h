#pragma once

#include <optional>

#include "core/light_path/bounce_limit.h"
#include "core/light_path/deposit.h"
#include "core/material/optics.h"
#include "core/scene/scene.h"

namespace caustics {

/// A particle on its way: one ray of a path or of a branch.
struct Flight {
    Ray ray;
    Spectrum flux;
    const Spectrum* start_medium = nullptr;  ///< absorption where the ray starts, if in a medium
    int bounces = 0;
    PathWavelength wavelength = {};
    float start_flux = 0;  ///< sum of the channels of the flux that the particle set out with
};

/// Roulette of long paths (chance_to_go_on); false where the flight ends.
inline bool survives(Flight& flight, Rng& rng) {
    if (flight.bounces < preset_bounces) return true;
    const float chance = chance_to_go_on(flight.bounces, flight.flux.sum() / flight.start_flux);
    if (chance >= 1) return true;
    if (rng.next() >= chance) return false;
    flight.flux /= chance;
    return true;
}

/// What a flight leaves where it has come to; nothing on a black side.
inline std::optional<Deposit> deposit_of(const Scene& scene, const SurfacePoint& hit,
                                         const Flight& flight) {
    const Vec3 wi = -flight.ray.direction;
    const bool front = hit.geometric_normal.dot(wi) > 0;
    if (!scatters_from(scene.shape_at(hit).bsdf, front)) return {};
    Deposit deposit;
    deposit.position = hit.position;
    deposit.geometric_normal = front ? hit.geometric_normal : Vec3(-hit.geometric_normal);
    deposit.shading_normal = front ? hit.shading_normal : Vec3(-hit.shading_normal);
    deposit.wi = wi;
    deposit.uv = hit.uv;
    deposit.offset = hit.offset;
    deposit.flux = flight.flux;
    deposit.shape = hit.shape;
    deposit.bounces = flight.bounces;
    deposit.front = front;
    return deposit;
}

/// Turns a flight to where it leaves a caster.
inline void leave(const Scene& scene, const SurfacePoint& hit, const Vec3& direction,
                  Flight& flight) {
    flight.start_medium = medium_after(scene.shape_at(hit).bsdf, hit.geometric_normal, direction,
                                       flight.start_medium);
    flight.ray = spawn_ray({hit.position, hit.geometric_normal, hit.offset}, direction);
    ++flight.bounces;
}

/// What a caster does with a flight, which gets a wavelength at its first dispersive one.
inline SpecularSplit split_at(const Scene& scene, const SurfacePoint& hit, Flight& flight,
                              Rng& rng) {
    const Bsdf& bsdf = scene.shape_at(hit).bsdf;
    flight.wavelength.arrive_at(bsdf, rng, flight.flux);
    return split_specular(bsdf, hit.geometric_normal, hit.shading_normal, -flight.ray.direction,
                          flight.wavelength.nm);
}

enum class Fate { reflected, refracted, absorbed, misdirected };

/// One decision for reflection, refraction or an end; the survivor's channels are rescaled so that the
/// mean over many particles is the split's weights [C11, after Jensen 2004].
inline Fate roulette(const SpecularSplit& split, Rng& rng, Spectrum& flux) {
    const float before = flux.sum();
    if (!(before > 0)) return Fate::absorbed;
    const Spectrum reflected = split.reflected_weight * flux;
    const Spectrum refracted = split.refracted_weight * flux;
    const float reflected_share = reflected.sum() / before;
    const float refracted_share = refracted.sum() / before;
    const float u = rng.next();
    if (u < reflected_share) {
        flux = reflected / reflected_share;
        return Fate::reflected;
    }
    if (u < reflected_share + refracted_share) {
        flux = refracted / refracted_share;
        return Fate::refracted;
    }
    const float lost_share = Spectrum(split.lost_weight * flux).sum() / before;
    return u < reflected_share + refracted_share + lost_share ? Fate::misdirected : Fate::absorbed;
}

}  // namespace caustics

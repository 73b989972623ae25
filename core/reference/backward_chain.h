#pragma once

#include <optional>

#include "core/material/optics.h"
#include "core/math/rng.h"
#include "core/render/eye_path.h"
#include "core/scene/scene.h"

namespace caustics {

/// A ray against the light through specular surfaces S*, by one random continuation at each, with what flux
/// that comes back along it would keep. (With normals interpolated over a mesh, radiance differs from that
/// by the cosines about the shading and the geometric normal: Veach 1997, sec. 5.3.)
struct BackwardChain {
    Ray ray;
    Spectrum weight = Spectrum::Ones();  ///< of radiance, Beer's law and (n / n')^2 included
    PathWavelength wavelength = {};
    const Spectrum* start_absorption = nullptr;  ///< where the ray starts, if in a medium
    int bounces = 0;
    float specular = 0;  ///< at the receiver that it ends at: the chance of another event there

    /// Roulette of long chains (chance_to_go_on); false where the chain ends.
    bool survives(Rng& rng);
    /// Beer's law up to a hit of the ray.
    void arrive(const SurfacePoint& hit, const Bsdf& bsdf);
    /// Turns at a caster to where it comes from; false where the chain ends by chance or on a wrong side.
    /// `chance` gets the probability of another event.
    bool turn(const SurfacePoint& hit, const Bsdf& bsdf, Rng& rng, float& chance);
};

/// The receiver at the end of a chain of at most `max_bounces` events, whose ray meets `hit`; none where it leaves
/// the scene or ends. A surface that is receiver and caster is either, by chance.
std::optional<WeightedPoint> receiver_ahead(const Scene& scene, BackwardChain& chain,
                                            std::optional<SurfacePoint> hit, int max_bounces,
                                            Rng& rng);

}  // namespace caustics

#pragma once

#include "core/material/optics.h"
#include "core/math/rng.h"
#include "core/reference/direction_mixture.h"
#include "core/scene/scene.h"

namespace caustics {

/// One sample of what light paths L S+ D leave at a point along its `wo` [W m^-2 sr^-1], or with f_r = 1
/// its irradiance [W m^-2], by a direction of the mixture and a random chain to a light with area.
Spectrum caustic_sample(const Scene& scene, const ReceiverPoint& point,
                        const DirectionMixture& mixture, bool with_bsdf, int max_bounces, Rng& rng);

}  // namespace caustics

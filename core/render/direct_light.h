#pragma once

#include "core/caustic_estimator.h"
#include "core/math/rng.h"
#include "core/scene/scene.h"

namespace caustics {

/// One sample of the radiance that light arriving straight from the lights (L D) leaves along the
/// point's `wo`. Area lights by multiple importance sampling of light and BSDF (balance
/// heuristic). Every surface between casts a full shadow, specular ones too.
Spectrum direct_radiance(const Scene& scene, const ReceiverPoint& point, Rng& rng);

}  // namespace caustics

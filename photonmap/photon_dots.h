#pragma once

#include <memory>

#include "core/caustic_estimator.h"
#include "photonmap/photons/photon_tracing.h"

namespace caustics::photonmap {

/// A drawing of the photons themselves, to be rendered in place of their caustic: a receiver point is
/// as bright as 1 + log2 of the number of photons within `radius` pixels of it, as wide as a pixel is
/// at its distance from the camera, in the colour of their flux (largest channel 1); black where
/// there are none. The eye pass hides what is hidden and bends what is seen through glass. No unit of
/// light.
std::unique_ptr<const CausticEstimator> photon_dots(const Scene& scene, TracedPhotons photons,
                                                    double radius, Isa isa);

}  // namespace caustics::photonmap

#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace caustics {

/// A hash of all that light paths from the lights to the receivers depend on: geometry, casters' and
/// lights' properties, and on which sides receivers scatter. Camera, film and what receivers reflect
/// do not count: a photon map serves another view and another receiver BRDF [J96 sec. 5].
std::uint64_t transport_hash(const Scene& scene);

/// The same of light paths between all surfaces: what receivers reflect counts too.
std::uint64_t whole_transport_hash(const Scene& scene);

}  // namespace caustics

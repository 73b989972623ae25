#pragma once

#include <span>

#include "core/math/vec.h"
#include "photonmap/photons/photon.h"

namespace caustics::photonmap {

/// The maximum radius [m] where none is given: 3 sqrt(N A / (pi n)), three times the radius of N
/// of n photons were they spread evenly over the area A. A is that of the box that holds the
/// photons between the 1st and 99th percentile of each coordinate, as ab + bc + ca of its sides
/// (ab for a floor), so that a few strays do not blow it up; of the scene's box where the photons
/// span no area.
double default_max_radius(std::span<const Photon> photons, const Box& scene_bounds, int nearest);

}  // namespace caustics::photonmap

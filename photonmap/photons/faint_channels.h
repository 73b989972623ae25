#pragma once

#include <span>

#include "photonmap/photons/photon.h"

namespace caustics::photonmap {

/// Of the channel where it is largest: the share of the flux that is carried by photons in which that
/// channel is one unit, 1/128 of the photon's greatest at most. There rounding at random (encode_rgbe)
/// leaves whole units on some photons and nothing on others, so that the channel scatters more
/// than the others, about an exact mean.
double faint_flux_share(std::span<const Photon> photons);

}  // namespace caustics::photonmap

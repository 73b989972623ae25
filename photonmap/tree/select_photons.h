#pragma once

#include <span>

#include "photonmap/photons/photon.h"

namespace caustics::photonmap {

/// Puts the photon of rank `rank` along `axis` in its place, with those before it not above and those
/// behind it not below it: Floyd and Rivest's selection (Comm. ACM 18, 1975), which partitions by
/// pivots taken from a sample close beside the wanted rank.
void select_photon(std::span<Photon> photons, std::size_t rank, unsigned axis);

}  // namespace caustics::photonmap

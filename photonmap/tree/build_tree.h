#pragma once

#include "photonmap/photons/photon_map_params.h"
#include "photonmap/tree/photon_tree.h"

namespace caustics::photonmap {

/// Orders the photons on up to `threads` threads (an unbalanced tree on one), in their memory where the kind allows it, with
/// less than 1 MB a thread besides. Throws InputError naming the first photon whose position is not finite.
std::unique_ptr<const PhotonTree> build_tree(TreeKind kind, PhotonStore photons, Isa isa,
                                             int threads = 1);

}  // namespace caustics::photonmap

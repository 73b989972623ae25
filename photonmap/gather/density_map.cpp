#include "photonmap/gather/density_map.h"

#include <utility>

#include "photonmap/tree/build_tree.h"

namespace caustics::photonmap {

DensityMap::DensityMap(PhotonStore photons, const RadianceEstimate::Settings& settings, Isa isa)
    : tree_(build_tree(TreeKind::packed, std::move(photons), isa)),
      settings_(settings),
      estimate_(settings, isa) {}

}  // namespace caustics::photonmap

#pragma once

#include "core/method/described_method.h"
#include "photonmap/photon_map.h"

namespace caustics::photonmap {

/// Relative names of files start at the folder of the file that names them (a sweep file), or at the
/// working folder.
const DescribedMethod<PhotonMapParams>& photonmap_method();

}  // namespace caustics::photonmap

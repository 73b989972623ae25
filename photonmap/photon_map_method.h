#pragma once

#include "core/method/described_method.h"
#include "photonmap/photon_map.h"

namespace caustics {

const DescribedMethod<PhotonMapParams>& photonmap_method();

}  // namespace caustics

#pragma once

#include "beamtree/beam_tree.h"
#include "core/method/described_method.h"

namespace caustics::beamtree {

const DescribedMethod<BeamTreeParams>& beamtree_method();

}  // namespace caustics::beamtree

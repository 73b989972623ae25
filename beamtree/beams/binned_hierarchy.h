#pragma once

#include <span>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/hierarchy.h"

namespace caustics::beamtree {

/// For any polygons ([CC95 sec. 4], future work): binary, split by 16 bins along the axis of
/// (position, reach * direction) whose halves have the least sum of n (their diagonals)^2.
/// `reach` is a typical distance to the receivers [m]; 0 splits by position alone.
Hierarchy binned_hierarchy(const BeamSet& set, std::span<const std::uint32_t> beams, float reach);

}  // namespace caustics::beamtree

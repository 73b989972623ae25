#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beamtree/beams/beam.h"

namespace caustics::beamtree {

/// Beams that are tested on planes across one fixed normal, which points against their light; or,
/// without one, across the receiver's.
struct PlaneGroup {
    std::optional<Vec3> normal;
    std::vector<std::uint32_t> beams;
};

/// All beams of the set in one group without a fixed normal (`leaf: receiver`).
std::vector<PlaneGroup> receiver_planes(const BeamSet& set);

/// The least sine at which rays come down to a fixed plane.
constexpr float least_sine = 0.25F;

/// Groups so that every ray of a group comes down to its planes at a sine of least_sine or
/// more (`leaf: fixed`): one group across an axis where all rays run down it at a sine of 0.5 or more, else
/// one across the middle of a cap that holds them all, else one for each of the six axes that rays
/// run along, and a last one without a fixed normal for beams that spread too far for any.
std::vector<PlaneGroup> fixed_planes(const BeamSet& set);

}  // namespace caustics::beamtree

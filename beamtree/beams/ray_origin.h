#pragma once

#include <cstdint>
#include <vector>

#include "beamtree/beams/beam.h"

namespace caustics::beamtree {

/// Where on the first caster's mesh a ray of a set has come from.
struct RayOrigin {
    static constexpr std::uint32_t no_vertex = ~0U;
    Vec3 position;
    Vec3 normal;                       ///< unit, interpolated
    Spectrum weight = black();         ///< strength after the last event
    std::uint32_t vertex = no_vertex;  ///< of the mesh, where it is one
    float left = 1;  ///< by the media on its way after the first event, of all light
    /// How far off the first surface a ray starts from here [m]: the most that any triangle about it asks for, so that
    /// neighbours go the same way from the places of their common edge, to the bit.
    float offset = 0;
};

/// A set while it is made.
struct TracedSet {
    BeamSet set;
    std::vector<RayOrigin> origins;  ///< one a ray
};

}  // namespace caustics::beamtree

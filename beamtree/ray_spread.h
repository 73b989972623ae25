#pragma once

#include <cstdint>
#include <span>

#include "beamtree/beam.h"
#include "beamtree/mesh_neighbours.h"

namespace caustics {

/// Where on the caster's mesh a ray of a set has come from.
struct RayOrigin {
    static constexpr std::uint32_t no_vertex = ~0U;
    Vec3 position;              ///< on the first surface
    Vec3 normal;                ///< unit, of the first surface there
    Spectrum weight = black();  ///< strength after the last event
    std::uint32_t vertex = no_vertex;
    std::uint32_t path =
        0;  ///< the same number: the same surfaces without a crease, met in the same order
};

/// Gives the set its spreads and partners (`intensity: refined`). A vertex ray's spread comes from
/// the derivatives of first surface, place and direction, of a quadratic surface fitted to the rays
/// of the vertices round it; their errors are of second order on any mesh. Rays that start at no
/// vertex, or have too few neighbours that went the same way, have no spread.
void refine(BeamSet& set, std::span<const RayOrigin> origins, const MeshNeighbours& neighbours);

}  // namespace caustics

#pragma once

#include <array>
#include <cstdint>

#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics::beamtree {

/// Where a pencil has come to on a receiver. Round there it is taken for parallel rays that lie evenly in a parallelogram
/// across them.
struct PencilPrint {
    Vec3 position;
    Vec3 normal;                ///< unit, geometric, on the side of arrival
    Vec3 wi;                    ///< unit, where it came from
    std::array<Vec3, 2> sides;  ///< of its image on the tangent plane [m]
    Spectrum flux = black();    ///< [W]
    std::uint32_t light = 0;    ///< index of the light sample
    std::uint32_t events = 1;   ///< specular ones, from the light to here
    bool flat = false;          ///< the receiver is a plane
};

}  // namespace caustics::beamtree

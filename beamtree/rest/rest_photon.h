#pragma once

#include <cstdint>

#include "core/material/wavelength.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics::beamtree {

/// Light that no beam carries, where it has come to a receiver.
struct RestPhoton {
    Vec3 position;
    Vec3 normal;              ///< unit, geometric, on the side of arrival
    Vec3 wi;                  ///< unit, where it came from
    Spectrum flux = black();  ///< [W]
    WavelengthBin bin = {};   ///< of its light's wavelengths; nm 0: all
    bool is_sample = false;   ///< tells how much light is missing, and lights nothing
};

}  // namespace caustics::beamtree

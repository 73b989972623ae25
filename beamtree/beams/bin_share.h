#pragma once

#include "core/material/wavelength.h"

namespace caustics::beamtree {

/// What makes a bin's light that of one wavelength which the picture without dispersion has: the bin's, but for its
/// colour.
Spectrum whitened(const WavelengthBin& bin);
/// What light of a bin of wavelengths counts for a viewer, behind glass that has chosen the wavelength nm, for which
/// light of all others is black, or of all wavelengths (0).
Spectrum share_of_bin(const WavelengthBin& bin, float nm);

}  // namespace caustics::beamtree

#pragma once

#include <cstddef>
#include <vector>

#include "core/math/rng.h"
#include "core/math/spectrum.h"

namespace caustics {

/// Wavelengths of light [nm], and what light of one of them is to a picture's channels. White light
/// without dispersion is the mean over wavelengths with the density channel_density(), channel by
/// channel, so that it stays white.

inline constexpr double shortest_wavelength = 380;
inline constexpr double longest_wavelength = 730;
/// The yellow helium line, where a glass catalogue gives its n_d.
inline constexpr float d_line = 587.5618F;

/// c_k: the densities of the linear sRGB channels [1/nm], each with integral 1 over
/// 380..730 nm, nowhere negative. The colour matching functions of CIE 1931 by the multi-lobe fit of
/// Wyman, Sloan and Shirley (2013), through the matrix of sRGB, negatives set to 0.
SpectrumSum channel_density(double nm);

/// A wavelength drawn for a path, and what its light is multiplied by from there on: c_k over the mean
/// of the channels' densities, by which it was drawn. The three channels of the weight add up to 3, so
/// that white light of any wavelength carries equal power.
struct SampledWavelength {
    float nm = 0;
    Spectrum weight = Spectrum::Ones();
};
/// `u` is uniform in [0, 1).
SampledWavelength sample_wavelength(double u);

/// A part of all wavelengths that takes one way: with the index of refraction at `nm`.
struct WavelengthBin {
    float nm = 0;                        ///< the mean of the bin, by the channels' mean density
    float from = 0;                      ///< [nm]
    float to = 0;                        ///< [nm]; the next bin's `from`
    Spectrum weight = Spectrum::Ones();  ///< integral of c_k; those of all bins add up to 1
};
/// Integral of c_k between two wavelengths [nm].
SpectrumSum channel_integral(double from, double to);
/// `count` >= 1 bins of equal power of white light, from the shortest wavelength on.
std::vector<WavelengthBin> wavelength_bins(int count);

}  // namespace caustics

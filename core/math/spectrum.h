#pragma once

#include <Eigen/Core>

namespace caustics {

/// Weights of linear sRGB (BT.709 primaries, D65 white); flux [W], radiance [W m^-2 sr^-1],
/// irradiance [W m^-2] or a dimensionless factor, as the name says. Never negative for light.
using Spectrum = Eigen::Array3f;
/// For sums over many samples.
using SpectrumSum = Eigen::Array3d;

inline Spectrum black() { return Spectrum::Zero(); }
inline bool is_black(const Spectrum& s) { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
inline bool is_finite(const Spectrum& s) { return s.isFinite().all(); }

}  // namespace caustics

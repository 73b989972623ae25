#pragma once

#include <complex>
#include <cstdint>

#include "core/geometry/height_grid.h"

namespace caustics {

/// Fractal ground by spectral synthesis [Saupe 1988]: z = Re sum of a exp(i k . x) over the waves
/// that repeat with the rectangle, a complex Gaussian with E |a|^2 ~ |k|^-(2 hurst + 2), so that the
/// mean square of z(x + d) - z(x) grows as |d|^(2 hurst). Waves longer than the rectangle are missing,
/// which shows on smooth ground: 2 hurst = 1.6 comes out as 1.44 over 8 to 128 of 1024 cells.
struct FractalField {
    static constexpr int least_levels = 2;  ///< one has no wave but the mean's
    static constexpr int most_levels = 12;  ///< 4096 cells along x and y, 33.6 million triangles

    int levels = 8;      ///< 2^levels cells along x and y, and all waves these resolve
    double hurst = 0.8;  ///< 0 .. 1, from rough to smooth
    double rms = 0;      ///< root of the mean square height [m]
    /// Waves along the rectangle's longer side below which |a|^2 is damped by (|k| / k_lowest)^4.
    double lowest = 1;
    std::uint64_t seed = 0;
    Vec2d half_size = Vec2d::Ones();  ///< of the rectangle round the origin [m]
};

/// The amplitude of the wave that runs m times along x and n times along y, before the heights are
/// scaled to `rms`. It depends on m, n, the seed and the spectrum alone, and not on the levels.
std::complex<double> fractal_amplitude(const FractalField& field, int m, int n);

/// Heights and slopes; the phases count from the corner (-half_size.x, -half_size.y). Only those of
/// `unscaled` heights are the same for more levels.
HeightGrid fractal_grid(const FractalField& field, bool unscaled = false);

}  // namespace caustics

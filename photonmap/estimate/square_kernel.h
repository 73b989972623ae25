#pragma once

#include <vector>

#include "photonmap/estimate/density_filter.h"

namespace caustics::photonmap {

/// The mean of the radiance estimate over a square about a point, `footprint`: the estimate's kernel convolved with
/// the square. On the tangent plane, (x, y) along the square's sides 2 s, a photon weighs
///
///   w(x, y) = t(x) t(y) / (2 s)^2,   t(x) = F((x + s) / h) - F((x - s) / h),
///
/// F being the integral of the filter's profile along an axis from its middle, F(1) = 1/2. The kernel's own square,
/// of half width h = 0.985 r / sqrt(2), lies in the disc of radius r that N nearest photons set. Where they
/// lie close against the square, w counts the photons in it; where they lie far, w is the filter.
///
/// w has the integral 1, so that the mean in a uniform field is the truth for a given r. Where r is the N-th photon's
/// distance, the photons within it are N - 1 in place of r's own mean. It is the truth again, exactly, when
/// the N-th photon itself weighs g'(a): g(a) is the integral of w over the disc of area a = pi r^2. The N-th
/// photon's area has a Gamma law f_N(a); with d photons an area, f_N' = d (f_{N-1} - f_N), so that
///
///   E[(N - 1) / a g + d (1 - g) + g'] = d E_{N-1}[g] + d - d E_N[g] + d (E_N[g] - E_{N-1}[g]) = d.
///
/// That weight goes from 0, a small square's (the outermost photon is left out), to that of all others in a large one.
class SquareKernel {
public:
    /// The side [m], and the share of the squared radius that the kernel takes (pass_share).
    SquareKernel(const DensityFilter& filter, double side, double share);

    /// How the kernel lies round a photon.
    struct Reach {
        double half = 0;   ///< s [m]
        double reach = 0;  ///< h [m]
        double rim = 0;    ///< the N-th photon's weight, over 1 / (2 s)^2
    };
    /// For a disc of that radius [m], above 0.
    Reach reach(double radius) const;
    /// What the kernels multiply by z (SquareWeighingKernel).
    const FilterPolynomial& profile() const { return profile_; }

private:
    double rim_weight(double p) const;

    FilterPolynomial profile_;
    double half_;
    double narrowing_;         ///< h / r
    std::vector<double> rim_;  ///< at even steps of p / (1 + p), p = r / s
};

}  // namespace caustics::photonmap

#pragma once

#include "photonmap/kernels/shading_kernel.h"
#include "photonmap/photons/photon_map_params.h"

namespace caustics::photonmap {

/// A filter and its numbers.
struct DensityFilter {
    FilterKind kind = FilterKind::none;
    double k = 1.1;       ///< of the cone, 1 or more
    double beta = 1.953;  ///< of the Gaussian, above 0
    double alpha = 0;     ///< of the Gaussian as printed; 0: normalised instead

    /// The weight at a squared distance over squared radius of u, in [0, 1]. Its mean over the
    /// disc, the integral over u, is 1:
    ///
    ///   none          1
    ///   cone          (1 - sqrt(u) / k) / (1 - 2 / (3 k)) [Jensen 2001]
    ///   gaussian      (exp(-b u / 2) - exp(-b)) / (2 (1 - exp(-b / 2)) / b - exp(-b))
    ///   epanechnikov  2 (1 - u) [Epanechnikov 1969]
    ///
    /// The Gaussian is the filter of Jensen 2001, a (1 - (1 - exp(-b u / 2)) / (1 - exp(-b))), without
    /// its a of 0.918: with that its mean is 0.531, and pictures come out at half their light. Where
    /// `alpha` is given it is used as printed.
    double weight(double u) const;
    /// The same as the kernels take it, to 1e-6; to 1e-5 for a beta above 3.
    FilterPolynomial polynomial() const;
    /// The weight along an axis, at (z, 0) for z in [-1, 1], integrated from the middle and divided by z; 1/2 at z = 1.
    FilterPolynomial profile_integral() const;
};

}  // namespace caustics::photonmap

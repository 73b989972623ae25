#pragma once

#include "photonmap/kernels/shading_kernel.h"
#include "photonmap/photons/photon_map_params.h"

namespace caustics {

/// A filter's weight at a squared distance over squared radius of u, in [0, 1]. Its mean over the
/// disc, the integral over u, is 1:
///
///   none          1
///   cone          (1 - sqrt(u) / c) / (1 - 2 / (3 c)),  c = 1.1 [Jensen 2001]
///   gaussian      (exp(-b u / 2) - exp(-b)) / (2 (1 - exp(-b / 2)) / b - exp(-b)),  b = 1.953
///   epanechnikov  2 (1 - u) [Epanechnikov 1969]
///
/// The Gaussian is the filter of Jensen 2001, alpha (1 - (1 - exp(-b u / 2)) / (1 - exp(-b))),
/// without its alpha of 0.918: with that its mean is 0.531, and pictures come out at half their
/// light.
double filter_weight(FilterKind kind, double u);

/// The same as the kernels take it, to 1e-6.
const FilterPolynomial& filter_polynomial(FilterKind kind);

}  // namespace caustics

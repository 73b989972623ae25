#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/math/rng.h"

namespace caustics {

/// Draws few of many weighted points so that weighted sums stay as they are: the flight phase of the cube method
/// [Deville and Tillé 2004], without an upper bound of the weights, so that Carathéodory's theorem says how many
/// points it ends with.
///
/// `values` has a row a function and a column a point; its first row is above 0. Of the weights (0 or above, one a
/// column) all but as many as there are functions become 0. No sum of weight times value over the points changes but
/// for rounding, and each weight's expectation is what it was: so the sum of any other function is right on average.
/// Columns side by side should be of points side by side: groups of them are left out together, half of the groups at
/// a time [Litterer and Lyons 2012].
void recombine(std::vector<double>& weights, const Eigen::MatrixXd& values, Rng& rng);

}  // namespace caustics

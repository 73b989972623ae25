#pragma once

#include <array>
#include <cmath>

namespace caustics::beamtree {

/// The part of a number behind its whole part, in [0, 1).
inline double fine_fraction(double x) { return x - std::floor(x); }

/// Steps of the two-dimensional low-discrepancy sequence of Roberts (2018): fine_fraction(shift + n * step) of each for n = 0, 1, ...
inline constexpr std::array<double, 2> r2_steps = {0.7548776662466927, 0.5698402909980532};

}  // namespace caustics::beamtree

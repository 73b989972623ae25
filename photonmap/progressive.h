#pragma once

#include <cstdint>

namespace caustics::photonmap {

/// Progressive photon mapping by independent passes [Knaus & Zwicker 2011]: the mean of the
/// estimates of many maps, each with smaller discs, so that noise and blur both vanish while the
/// memory is that of one map. Pass i = 0, 1, 2, ... multiplies every squared radius, the fixed one
/// or that of the N nearest photons of its own map, by
///
///   s_i = product over j = 1, ..., i of (j + a) / (j + 1),  a = 2/3,
///
/// which falls as i^(a-1). A pass's variance goes as 1/s_i and its bias as s_i, so that after M
/// passes the variance of the mean falls as M^-a and its squared bias as M^(2a-2): with a = 2/3 the
/// mean squared error falls as M^(-2/3), the fastest there is for any a.
double pass_share(int pass);

/// The seed of a pass; that of pass 0 is the run's own, so that one pass is an ordinary map.
std::uint64_t pass_seed(std::uint64_t seed, int pass);

}  // namespace caustics::photonmap

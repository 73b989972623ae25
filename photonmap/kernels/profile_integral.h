#pragma once

#include "photonmap/kernels/shading_kernel.h"

namespace caustics::photonmap {

/// A kernel's integral along an axis from its middle to z, odd; z = 1 is its end. `profile` times z, as
/// SquareWeighingKernel says.
template <typename Lanes>
typename Lanes::Floats profile_integral(const FilterPolynomial& profile, typename Lanes::Floats z) {
    const auto one = Lanes::all(1);
    const auto minus_one = Lanes::all(-1);
    z = Lanes::max(Lanes::min(z, one), minus_one);
    const auto x = profile.of_distance ? Lanes::max(z, Lanes::mul(z, minus_one)) : Lanes::mul(z, z);
    auto value = Lanes::all(profile.coefficient[profile.degree]);
    for (size_t n = profile.degree; n-- > 0;)
        value = Lanes::add(Lanes::mul(value, x), Lanes::all(profile.coefficient[n]));
    return Lanes::mul(value, z);
}

}  // namespace caustics::photonmap

#pragma once

#include "photonmap/kernels/shading_kernel.h"

namespace caustics::photonmap {

/// WeighingKernel for registers of one kind.
template <typename Lanes>
void weigh_photons(const FilterPolynomial& filter, const FilteredPhotons& photons) {
    const auto scale = Lanes::all(photons.inverse_squared_radius);
    const auto one = Lanes::all(1);
    const float* const squared_distance = photons.squared_distance;
    for (size_t i = 0; i < photons.count; i += Lanes::width) {
        // At most 1 but for rounding.
        auto x = Lanes::min(Lanes::mul(Lanes::load(squared_distance + i), scale), one);
        if (filter.of_distance) x = Lanes::sqrt(x);
        auto weight = Lanes::all(filter.coefficient[filter.degree]);
        for (size_t n = filter.degree; n-- > 0;)
            weight = Lanes::add(Lanes::mul(weight, x), Lanes::all(filter.coefficient[n]));
        Lanes::store(photons.weight + i, weight);
    }
}

}  // namespace caustics::photonmap

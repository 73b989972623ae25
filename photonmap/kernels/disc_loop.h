#pragma once

#include "photonmap/kernels/profile_integral.h"

namespace caustics::photonmap {

/// The weights of photons that have a disc each, for registers of one kind.
template <typename Lanes>
struct DiscLoop {
    /// DiscWeighingKernel.
    static void weigh(const FilterPolynomial& filter, const PhotonsWithDiscs& photons) {
        const auto one = Lanes::all(1);
        const auto inverse_pi = Lanes::all(0.31830989F);
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            const Floats r = Lanes::load(photons.radius + i);
            const Floats inverse = Lanes::div(one, Lanes::mul(r, r));
            // At most 1 but for rounding.
            Floats x =
                Lanes::min(Lanes::mul(Lanes::load(photons.squared_distance + i), inverse), one);
            if (filter.of_distance) x = Lanes::sqrt(x);
            Floats weight = Lanes::all(filter.coefficient[filter.degree]);
            for (size_t n = filter.degree; n-- > 0;)
                weight = Lanes::add(Lanes::mul(weight, x), Lanes::all(filter.coefficient[n]));
            Lanes::store(photons.weight + i, Lanes::mul(weight, Lanes::mul(inverse, inverse_pi)));
        }
    }

    /// CellWeighingKernel.
    static void weigh_on_cell(const FilterPolynomial& profile, const PhotonsOnCell& photons) {
        const auto one = Lanes::all(1);
        const auto width = Lanes::all(photons.width);
        const auto inverse_sine = Lanes::all(photons.inverse_sine);
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            const Floats reach = Lanes::mul(width, Lanes::load(photons.radius + i));
            const Kernel kernel{reach, Lanes::div(one, reach)};
            Floats offset[3];
            for (unsigned axis = 0; axis < 3; ++axis)
                offset[axis] = Lanes::sub(Lanes::load(photons.position[axis] + i),
                                          Lanes::all(photons.centre[axis]));
            const Floats density = Lanes::mul(mean_along(profile, photons, 0, kernel, offset),
                                              mean_along(profile, photons, 1, kernel, offset));
            Lanes::store(photons.weight + i, Lanes::mul(density, inverse_sine));
        }
    }

private:
    using Floats = typename Lanes::Floats;

    struct Kernel {
        Floats reach, inverse;
    };

    /// Mean of the kernel along one side of the cell [1/m].
    static Floats mean_along(const FilterPolynomial& profile, const PhotonsOnCell& photons,
                             unsigned side, const Kernel& kernel, const Floats* offset) {
        // Differences of the integral in floats keep their digits where the side is not too small against the kernel:
        // a smaller one is enlarged.
        const Floats half = Lanes::max(Lanes::all(photons.half[side]),
                                       Lanes::mul(kernel.reach, Lanes::all(1.0F / 64)));
        const Floats inverse_side = Lanes::min(Lanes::all(photons.inverse_side[side]),
                                               Lanes::mul(kernel.inverse, Lanes::all(32)));
        const float* const v = photons.across[side];
        const Floats x = Lanes::add(Lanes::mul(Lanes::all(v[0]), offset[0]),
                                    Lanes::add(Lanes::mul(Lanes::all(v[1]), offset[1]),
                                               Lanes::mul(Lanes::all(v[2]), offset[2])));
        const Floats end =
            profile_integral<Lanes>(profile, Lanes::mul(Lanes::add(x, half), kernel.inverse));
        const Floats begin =
            profile_integral<Lanes>(profile, Lanes::mul(Lanes::sub(x, half), kernel.inverse));
        return Lanes::mul(Lanes::sub(end, begin), inverse_side);
    }
};

}  // namespace caustics::photonmap

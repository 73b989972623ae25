#pragma once

#include "photonmap/kernels/shading_kernel.h"

namespace caustics::photonmap {

/// SquareWeighingKernel for registers of one kind.
template <typename Lanes>
struct SquareLoop {
    static void weigh(const FilterPolynomial& profile, const PhotonsOnSquare& photons) {
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            Floats offset[3];
            for (unsigned axis = 0; axis < 3; ++axis)
                offset[axis] = Lanes::sub(Lanes::load(photons.position[axis] + i),
                                          Lanes::all(photons.centre[axis]));
            Lanes::store(photons.weight + i,
                         Lanes::mul(share(profile, photons, dot(photons.right, offset)),
                                    share(profile, photons, dot(photons.forward, offset))));
        }
    }

private:
    using Floats = typename Lanes::Floats;

    static Floats dot(const float* v, const Floats* offset) {
        return Lanes::add(Lanes::mul(Lanes::all(v[0]), offset[0]),
                          Lanes::add(Lanes::mul(Lanes::all(v[1]), offset[1]),
                                     Lanes::mul(Lanes::all(v[2]), offset[2])));
    }

    /// Of the kernel round a photon at x, along one axis, what lies within the square.
    static Floats share(const FilterPolynomial& profile, const PhotonsOnSquare& photons, Floats x) {
        const auto half = Lanes::all(photons.half);
        const auto scale = Lanes::all(photons.inverse_reach);
        return Lanes::sub(below(profile, Lanes::mul(Lanes::add(x, half), scale)),
                          below(profile, Lanes::mul(Lanes::sub(x, half), scale)));
    }

    /// The kernel's integral from its middle to z, odd.
    static Floats below(const FilterPolynomial& profile, Floats z) {
        const auto one = Lanes::all(1);
        const auto minus_one = Lanes::all(-1);
        z = Lanes::max(Lanes::min(z, one), minus_one);
        const auto x =
            profile.of_distance ? Lanes::max(z, Lanes::mul(z, minus_one)) : Lanes::mul(z, z);
        auto value = Lanes::all(profile.coefficient[profile.degree]);
        for (size_t n = profile.degree; n-- > 0;)
            value = Lanes::add(Lanes::mul(value, x), Lanes::all(profile.coefficient[n]));
        return Lanes::mul(value, z);
    }
};

}  // namespace caustics::photonmap

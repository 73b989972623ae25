#pragma once

#include "photonmap/kernels/profile_integral.h"

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
        return Lanes::sub(profile_integral<Lanes>(profile, Lanes::mul(Lanes::add(x, half), scale)),
                          profile_integral<Lanes>(profile, Lanes::mul(Lanes::sub(x, half), scale)));
    }
};

}  // namespace caustics::photonmap

#pragma once

#include <stddef.h>

#include "photonmap/kernels/cosine_power.h"
#include "photonmap/kernels/shading_kernel.h"
#include "photonmap/kernels/two_of.h"

namespace caustics::photonmap {

/// The formula of phong_factors over registers of one kind. `Set` has their `Lanes`, `Vectors` (x, y and z of them),
/// `Mask` of photons, `Sums` of energies, `directions`, and `facing`: the photons from the i-th on that count and
/// whose cosine n.wi is above 0.
template <typename Set>
class PhongLoop {
public:
    static void add(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                    double* rgb) {
        constexpr size_t width = Lanes::width;
        PhongLoop loop(tables, lobe, photons);
        size_t i = 0;
        for (; i + width < photons.count; i += 2 * width) loop.add_two(i);
        if (i < photons.count) loop.add_one(i);
        loop.sums_.add_to(rgb);
    }

private:
    using Lanes = typename Set::Lanes;
    using Floats = typename Lanes::Floats;
    using Vectors = typename Set::Vectors;
    struct Arrival {
        Floats t;  ///< 1 - cosine of the angle to the mirrored direction
        typename Set::Mask lanes;
    };

    PhongLoop(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons)
        : tables_(tables), lobe_(lobe), photons_(photons) {}

    void add_one(size_t i) {
        const Arrival arrival = arrival_of(i);
        add(i, arrival, power<Lanes>(arrival.t));
    }
    void add_two(size_t i) {
        const Arrival first = arrival_of(i), second = arrival_of(i + Lanes::width);
        const auto both = power<TwoOf<Lanes>>({first.t, second.t});
        add(i, first, both.first);
        add(i + Lanes::width, second, both.second);
    }
    [[gnu::always_inline]] inline Arrival arrival_of(size_t i) const {
        const Vectors wi = Set::directions(tables_, photons_.direction + i);
        const Vectors apart{Lanes::sub(mirrored_.x, wi.x), Lanes::sub(mirrored_.y, wi.y),
                            Lanes::sub(mirrored_.z, wi.z)};
        return {Lanes::mul(Lanes::all(0.5F), dot(apart, apart)),
                Set::facing(photons_, i, dot(normal_, wi))};
    }
    template <typename Some>
    typename Some::Floats power(typename Some::Floats t) const {
        if (Some::less(t, Some::all(1)) == 0) return Some::all(0);
        return cosine_power<Some>(t, lobe_.exponent);
    }
    void add(size_t i, const Arrival& arrival, Floats power) {
        sums_.add(photons_, i, arrival.lanes,
                  Vectors{Lanes::add(diffuse_.x, Lanes::mul(specular_.x, power)),
                          Lanes::add(diffuse_.y, Lanes::mul(specular_.y, power)),
                          Lanes::add(diffuse_.z, Lanes::mul(specular_.z, power))});
    }
    static Vectors all_of(const float* v) {
        return {Lanes::all(v[0]), Lanes::all(v[1]), Lanes::all(v[2])};
    }
    static Floats dot(const Vectors& a, const Vectors& b) {
        return Lanes::add(Lanes::mul(a.x, b.x),
                          Lanes::add(Lanes::mul(a.y, b.y), Lanes::mul(a.z, b.z)));
    }

    const DirectionTables& tables_;
    const Lobe& lobe_;
    const ShadedPhotons& photons_;
    const Vectors normal_ = all_of(lobe_.normal), mirrored_ = all_of(lobe_.mirrored);
    const Vectors diffuse_ = all_of(lobe_.diffuse), specular_ = all_of(lobe_.specular);
    typename Set::Sums sums_;
};

}  // namespace caustics::photonmap

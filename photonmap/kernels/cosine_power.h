#pragma once

namespace caustics::photonmap {

/// cos^exponent of an angle given by t = 1 - cos, 0 <= t; 0 from a right angle on. For registers of one
/// kind, the same bits by all; the relative error is 1e-6 or less, and that of t times the exponent, however
/// near 1 the cosine is.
template <typename Lanes>
typename Lanes::Floats cosine_power(typename Lanes::Floats t, float exponent) {
    using Floats = typename Lanes::Floats;
    const auto polynomial = [](Floats x, const auto& coefficients) {
        Floats value = Lanes::all(0);
        for (const float coefficient : coefficients)
            value = Lanes::add(Lanes::mul(value, x), Lanes::all(coefficient));
        return value;
    };
    const Floats one = Lanes::all(1);
    // cos = (1 + f) 2^k, 1 + f from sqrt(1/2) to sqrt(2). Where k is 0, f is -t: nothing is rounded.
    const Floats cosine = Lanes::sub(one, t);
    Floats k = Lanes::exponent_of(cosine);
    Floats mantissa = Lanes::mantissa_of(cosine);
    const auto upper = Lanes::is_less(Lanes::all(1.41421356F), mantissa);
    k = Lanes::chosen(upper, Lanes::add(k, one), k);
    mantissa = Lanes::chosen(upper, Lanes::mul(mantissa, Lanes::all(0.5F)), mantissa);
    const Floats f = Lanes::chosen(Lanes::is_equal(k, Lanes::all(0)), Lanes::sub(Lanes::all(0), t),
                                   Lanes::sub(mantissa, one));
    // log2(1 + f) = 2 artanh(s) / ln 2, s = f / (2 + f).
    constexpr float artanh[] = {1.0F / 9, 1.0F / 7, 1.0F / 5, 1.0F / 3, 1};
    const Floats s = Lanes::div(f, Lanes::add(Lanes::all(2), f));
    const Floats series = Lanes::mul(s, polynomial(Lanes::mul(s, s), artanh));
    const Floats log2 = Lanes::add(Lanes::mul(series, Lanes::all(2.88539008F)), k);
    // 2^(n + rest), rest within half of 0.
    const Floats power = Lanes::mul(Lanes::all(exponent), log2);
    const Floats least = Lanes::all(-126);
    const Floats shift = Lanes::all(12582912);  // 1.5 x 2^23: what is added to it is rounded
    const Floats n = Lanes::sub(Lanes::add(Lanes::max(power, least), shift), shift);
    constexpr float exp2[] = {1.52527338e-5F, 1.54035304e-4F, 1.33335581e-3F, 9.61812911e-3F,
                              5.55041087e-2F, 2.40226507e-1F, 6.93147181e-1F, 1};
    const Floats value =
        Lanes::times_power_of_2(polynomial(Lanes::sub(Lanes::max(power, least), n), exp2), n);
    const Floats kept = Lanes::chosen(Lanes::is_less(power, least), Lanes::all(0), value);
    return Lanes::chosen(Lanes::is_less(t, one), kept, Lanes::all(0));
}

}  // namespace caustics::photonmap

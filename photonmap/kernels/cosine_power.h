#pragma once

namespace caustics::photonmap {

/// cos^exponent of an angle given by t = 1 - cos, 0 <= t; 0 from a right angle on, and where it is below
/// 2^-125. For registers of one kind, the same bits by all; the relative error is 1e-6 or less, and that of t
/// times the exponent, however near 1 the cosine is.
///
/// Inlined always, and polynomials by pairs (Estrin's scheme): what is waited for is the length of the chain.
template <typename Lanes>
[[gnu::always_inline]] inline typename Lanes::Floats cosine_power(typename Lanes::Floats t,
                                                                  float exponent) {
    using Floats = typename Lanes::Floats;
    const auto line = [](float constant, float slope, Floats x) {
        return Lanes::add(Lanes::all(constant), Lanes::mul(Lanes::all(slope), x));
    };
    const auto plus = [](Floats a, Floats b, Floats x) { return Lanes::add(a, Lanes::mul(b, x)); };
    const Floats one = Lanes::all(1);
    // cos = (1 + f) 2^k, 1 + f from sqrt(1/2) to sqrt(2). Where k is 0, f is -t: nothing is rounded.
    Floats mantissa;
    const Floats k = Lanes::split(Lanes::sub(one, t), &mantissa);
    const Floats f = Lanes::chosen(Lanes::is_equal(k, Lanes::all(0)), Lanes::sub(Lanes::all(0), t),
                                   Lanes::sub(mantissa, one));
    // log2(1 + f) = 2 artanh(s) / ln 2, s = f / (2 + f).
    const Floats s = Lanes::div(f, Lanes::add(Lanes::all(2), f));
    const Floats s2 = Lanes::mul(s, s);
    const Floats s4 = Lanes::mul(s2, s2);
    const Floats artanh = plus(plus(line(1, 1.0F / 3, s2), line(1.0F / 5, 1.0F / 7, s2), s4),
                               Lanes::all(1.0F / 9), Lanes::mul(s4, s4));
    const Floats log2 = plus(k, artanh, Lanes::mul(s, Lanes::all(2.88539008F)));
    // 2^(n + rest), rest within half of 0.
    const Floats power = Lanes::mul(Lanes::all(exponent), log2);
    const Floats least = Lanes::all(-125);
    const Floats bounded = Lanes::max(power, least);
    const Floats shift = Lanes::all(12582912);  // 1.5 x 2^23: what is added to it is rounded
    const Floats shifted = Lanes::add(bounded, shift);
    const Floats x = Lanes::sub(bounded, Lanes::sub(shifted, shift));
    const Floats x2 = Lanes::mul(x, x);
    const Floats low =
        plus(line(1, 6.93147181e-1F, x), line(2.40226507e-1F, 5.55041087e-2F, x), x2);
    const Floats high =
        plus(line(9.61812911e-3F, 1.33335581e-3F, x), Lanes::all(1.54035304e-4F), x2);
    const Floats value = Lanes::times_power_of_2(plus(low, high, Lanes::mul(x2, x2)), shifted);
    const Floats kept = Lanes::chosen(Lanes::is_less(power, least), Lanes::all(0), value);
    return Lanes::chosen(Lanes::is_less(t, one), kept, Lanes::all(0));
}

}  // namespace caustics::photonmap

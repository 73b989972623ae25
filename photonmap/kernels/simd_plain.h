#pragma once

#include <stddef.h>
#include <stdint.h>

namespace caustics::photonmap {

/// Registers of one lane: the plain C++ of the kernels that are written for any width. Masks hold
/// lane i in bit i. Every width does the same operations, each rounded to float, in the same order,
/// so that results are the same bits. `compress` puts the masked lanes side by side and may write
/// a whole register.
struct PlainSimd {
    static constexpr size_t width = 1;
    using Floats = float;
    using Words = uint32_t;

    static Floats load(const float* from) { return *from; }
    static Words load(const uint32_t* from) { return *from; }
    static Words load_halves(const uint16_t* from) { return *from; }
    static Floats all(float value) { return value; }
    static Words counting_from(uint32_t first) { return first; }
    static void store(float* to, Floats a) { *to = a; }
    static void store(uint32_t* to, Words a) { *to = a; }
    /// Whole numbers with a sign, the fraction cut off; words wrap round.
    static Words whole(Floats a) { return static_cast<uint32_t>(static_cast<int32_t>(a)); }
    static Words no_words() { return 0; }
    static Words add_where(uint32_t mask, Words a, Words b) { return mask != 0 ? a + b : a; }
    static uint32_t sum(Words a) { return a; }
    static Floats add(Floats a, Floats b) { return a + b; }
    static Floats sub(Floats a, Floats b) { return a - b; }
    static Floats mul(Floats a, Floats b) { return a * b; }
    static Floats div(Floats a, Floats b) { return a / b; }
    static Floats sqrt(Floats a) { return __builtin_sqrtf(a); }
    static Floats min(Floats a, Floats b) { return a < b ? a : b; }
    static Floats max(Floats a, Floats b) { return a > b ? a : b; }
    static uint32_t less(Floats a, Floats b) { return a < b ? 1U : 0U; }
    static uint32_t not_above(Floats a, Floats b) { return a <= b ? 1U : 0U; }
    /// A positive normal number in two: 2^e, of which e is returned, times `mantissa`, which is from
    /// sqrt(1/2) to sqrt(2).
    static Floats split(Floats a, Floats* mantissa) {
        const uint32_t above = bits_of(a) - bits_of(0.70710678F);
        const auto e = static_cast<int32_t>(above) >> 23;
        *mantissa = float_of(bits_of(a) - (static_cast<uint32_t>(e) << 23U));
        return static_cast<float>(e);
    }
    /// a 2^n for n + 1.5 x 2^23, n whole; a and the result are normal numbers.
    static Floats times_power_of_2(Floats a, Floats shifted) {
        return float_of(bits_of(a) + (bits_of(shifted) << 23U));
    }
    static size_t count(uint32_t mask) { return mask; }
    /// What comparisons say, where it chooses only.
    using Choice = bool;
    static Choice is_less(Floats a, Floats b) { return a < b; }
    static Choice is_equal(Floats a, Floats b) { return a == b; }
    static Floats chosen(Choice choice, Floats a, Floats b) { return choice ? a : b; }
    static Floats where(uint32_t mask, Floats a, Floats b) { return mask != 0 ? a : b; }
    static void compress(float* to, uint32_t, Floats a) { *to = a; }
    static void compress(uint32_t* to, uint32_t, Words a) { *to = a; }
    /// The words' low halves.
    static void compress_halves(uint16_t* to, uint32_t, Words a) { *to = static_cast<uint16_t>(a); }
    static float least(Floats a) { return a; }
    static float greatest(Floats a) { return a; }

private:
    static uint32_t bits_of(float a) { return __builtin_bit_cast(uint32_t, a); }
    static float float_of(uint32_t bits) { return __builtin_bit_cast(float, bits); }
};

}  // namespace caustics::photonmap

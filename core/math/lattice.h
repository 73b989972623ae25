#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace caustics {

/// The part of a number behind its whole part, in [0, 1).
inline double fine_fraction(double x) { return x - std::floor(x); }

/// Steps of Roberts' sequences in one to four dimensions (The unreasonable effectiveness of quasirandom sequences, 2018):
/// the powers -1, -2, ... of the root of x^(d+1) = x + 1, as parts of 2^64. Points shift + i * step, modulo 1, lie evenly for any
/// number of them. The roots of one, three and four dimensions are of fields of different degrees, so that these can stand beside
/// each other as the numbers of one point.
inline constexpr std::array<std::uint64_t, 1> r1_steps = {0x9E3779B97F4A7C15};
inline constexpr std::array<std::uint64_t, 2> r2_steps = {0xC13FA9A902A6328F, 0x91E10DA5C79E7B1C};
inline constexpr std::array<std::uint64_t, 3> r3_steps = {0xD1B54A32D192ED03, 0xABC98388FB8FAC02,
                                                          0x8CB92BA72F3D8DD7};
inline constexpr std::array<std::uint64_t, 4> r4_steps = {0xDB4F0B9175AE2165, 0xBBE0563303A4615F,
                                                          0xA0F2EC75A1FE1575, 0x89E182857D9ED688};

/// A number's place in [0, 1) as 32 bits.
constexpr std::uint32_t high_word(std::uint64_t part) {
    return static_cast<std::uint32_t>(part >> 32U);
}

/// A number of point i in [0, 1), by its step and its shift.
inline double on_lattice(double shift, std::uint64_t i, std::uint64_t step) {
    return fine_fraction(shift + static_cast<double>((i * step) >> 11U) * 0x1p-53);
}

}  // namespace caustics

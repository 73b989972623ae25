#include "photonmap/photons/rgbe.h"

#include <bit>
#include <stdexcept>

namespace caustics::photonmap {

namespace {

constexpr int exponent_bias = 128;

/// 2^exponent, for -126 <= exponent <= 127.
float power_of_two(int exponent) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23U);
}

/// More than float's rounding takes off a product of a few factors.
constexpr float rounding = 0x1p-20F;

struct Scaled {
    Spectrum mantissa;  ///< not rounded; the largest is `largest_mantissa` at most
    int exponent = -exponent_bias;
};

Scaled scaled_to(float largest_mantissa, const Spectrum& value) {
    const float largest = value.maxCoeff();
    // Comparisons fail for NaN; maxCoeff may pass one by.
    if (!(value[0] >= 0 && value[1] >= 0 && value[2] >= 0 && largest < 0x1p126F))
        throw std::range_error(is_finite(value) && (value >= 0).all()
                                   ? "value too large for rgbe"
                                   : "rgbe holds finite values that are not negative");
    if (largest < 0x1p-128F) return {black()};
    // Small values are lifted, so that the exponent of a subnormal one can be read off too.
    const int lift = largest < 1 ? 8 : 0;
    const auto bits = std::bit_cast<std::uint32_t>(largest * power_of_two(lift));
    int exponent = static_cast<int>(bits >> 23U) - 126 - lift;
    const Spectrum scaled = value * power_of_two(-exponent) * 256;
    float scale = 1;
    if (scaled.maxCoeff() >= largest_mantissa) {
        scale = 0.5F;
        ++exponent;
    }
    if (exponent + exponent_bias > 254) throw std::range_error("value too large for rgbe");
    return {scaled * scale, exponent};
}

std::uint8_t to_nearest(float mantissa) {
    return static_cast<std::uint8_t>(static_cast<int>(mantissa + 0.5F));
}

std::uint8_t at_random(float mantissa, double chance) {
    const auto nearest = static_cast<float>(static_cast<int>(mantissa + 0.5F));
    const float beyond = mantissa - nearest;
    if (beyond <= rounding * mantissa && -beyond <= rounding * mantissa)
        return static_cast<std::uint8_t>(nearest);
    const int below = static_cast<int>(mantissa);
    const bool up = chance < static_cast<double>(mantissa) - below;
    return static_cast<std::uint8_t>(below + (up ? 1 : 0));
}

std::uint8_t biased(int exponent) { return static_cast<std::uint8_t>(exponent + exponent_bias); }

}  // namespace

Rgbe encode_rgbe(const Spectrum& value) {
    // 255.5 and more would round to 256: such a value takes the next exponent.
    const auto [m, exponent] = scaled_to(255.5F, value);
    return {{to_nearest(m[0]), to_nearest(m[1]), to_nearest(m[2])}, biased(exponent)};
}

Rgbe encode_rgbe(const Spectrum& value, const std::array<double, 3>& chance) {
    const auto [m, exponent] = scaled_to(255 * (1 + rounding), value);
    return {{at_random(m[0], chance[0]), at_random(m[1], chance[1]), at_random(m[2], chance[2])},
            biased(exponent)};
}

Spectrum decode_rgbe(const Rgbe& code) {
    if (code.exponent == 0) return black();
    // 2^(exponent - 136) in two factors, because the smallest are no normal floats.
    const auto power = static_cast<std::uint32_t>(code.exponent) << 23U;
    const float scale = std::bit_cast<float>(power) * 0x1p-9F;
    return Spectrum(static_cast<float>(code.mantissa[0]), static_cast<float>(code.mantissa[1]),
                    static_cast<float>(code.mantissa[2])) *
           scale;
}

}  // namespace caustics::photonmap

#include "photonmap/rgbe.h"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace caustics {

namespace {

constexpr int exponent_bias = 128;

std::uint8_t rounded(float channel, int exponent) {
    return static_cast<std::uint8_t>(std::lround(std::ldexp(channel, 8 - exponent)));
}

}  // namespace

Rgbe encode_rgbe(const Spectrum& value) {
    if (!is_finite(value) || (value < 0).any())
        throw std::range_error("rgbe holds finite values that are not negative");
    const float largest = value.maxCoeff();
    int exponent = 0;
    std::frexp(largest, &exponent);
    // 255.5 and more would round to 256: such a value takes the next exponent.
    if (std::ldexp(largest, 8 - exponent) >= 255.5F) ++exponent;
    if (largest == 0 || exponent + exponent_bias < 1) return {};
    if (exponent + exponent_bias > 254) throw std::range_error("value too large for rgbe");
    return {{rounded(value[0], exponent), rounded(value[1], exponent), rounded(value[2], exponent)},
            static_cast<std::uint8_t>(exponent + exponent_bias)};
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

}  // namespace caustics

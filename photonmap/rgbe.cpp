#include "photonmap/rgbe.h"

#include <bit>
#include <stdexcept>

namespace caustics {

namespace {

constexpr int exponent_bias = 128;

/// 2^exponent, for -126 <= exponent <= 127.
float power_of_two(int exponent) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23U);
}

std::uint8_t rounded(float mantissa) {
    return static_cast<std::uint8_t>(static_cast<int>(mantissa + 0.5F));
}

}  // namespace

Rgbe encode_rgbe(const Spectrum& value) {
    const float largest = value.maxCoeff();
    // Comparisons fail for NaN; maxCoeff may pass one by.
    if (!(value[0] >= 0 && value[1] >= 0 && value[2] >= 0 && largest < 0x1p126F))
        throw std::range_error(is_finite(value) && (value >= 0).all()
                                   ? "value too large for rgbe"
                                   : "rgbe holds finite values that are not negative");
    if (largest < 0x1p-128F) return {};
    // Small values are lifted, so that the exponent of a subnormal one can be read off too.
    const int lift = largest < 1 ? 8 : 0;
    const auto bits = std::bit_cast<std::uint32_t>(largest * power_of_two(lift));
    int exponent = static_cast<int>(bits >> 23U) - 126 - lift;
    const Spectrum scaled = value * power_of_two(-exponent) * 256;
    float scale = 1;
    // 255.5 and more would round to 256: such a value takes the next exponent.
    if (scaled.maxCoeff() >= 255.5F) {
        scale = 0.5F;
        ++exponent;
    }
    if (exponent + exponent_bias > 254) throw std::range_error("value too large for rgbe");
    return {{rounded(scaled[0] * scale), rounded(scaled[1] * scale), rounded(scaled[2] * scale)},
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

#pragma once

#include <array>
#include <cstdint>

#include "core/spectrum.h"

namespace caustics {

/// Three non-negative values in four bytes with a shared exponent [Ward, "Real pixels", Graphics
/// Gems II, 1991]: value = byte * 2^(exponent - 136). The largest channel keeps 7 to 8 bits.
struct Rgbe {
    std::array<std::uint8_t, 3> mantissa{};
    std::uint8_t exponent = 0;  ///< 0: all channels are exactly zero

    bool operator==(const Rgbe&) const = default;
};

/// Rounds to the nearest code, so that the error is at most 1/255 of the largest channel; zero
/// channels stay zero. Values below 2^-128 become zero. Throws std::range_error for values that
/// are negative, not finite, or too large (2^126 and more).
Rgbe encode_rgbe(const Spectrum& value);

Spectrum decode_rgbe(const Rgbe& code);

}  // namespace caustics

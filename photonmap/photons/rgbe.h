#pragma once

#include <array>
#include <cstdint>

#include "core/math/spectrum.h"

namespace caustics::photonmap {

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

/// Rounds each channel up or down at random such that the mean of the codes is the value, however
/// weak a channel is beside the largest: up where `chance`, uniform in [0, 1), is below what a
/// mantissa has beyond a whole number. A mantissa that is whole but for float's rounding needs no
/// chance. Exact to 1e-6 of the value and to the finest step of `chance`; else as above.
Rgbe encode_rgbe(const Spectrum& value, const std::array<double, 3>& chance);

Spectrum decode_rgbe(const Rgbe& code);

}  // namespace caustics::photonmap

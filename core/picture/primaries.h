#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace caustics {

/// Chromaticities as OpenEXR's attribute has them: x and y of red, green, blue and white.
using Primaries = std::array<float, 8>;

/// Of Rec. 709 and sRGB, which all colours here have, and which an OpenEXR file without the attribute has.
constexpr Primaries rec709_primaries = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};

/// Throws std::runtime_error for colours of other primaries (ACES, P3, ...): taken as they are, they would be other
/// colours.
inline void require_rec709(const Primaries& primaries) {
    constexpr float rounding = 1e-3F;  // of writers
    for (std::size_t i = 0; i < primaries.size(); ++i)
        // Negated, so that NaN is caught too.
        if (!(std::abs(primaries[i] - rec709_primaries[i]) <= rounding))
            throw std::runtime_error(
                "its attribute chromaticities names other primaries than those of Rec. 709; "
                "convert its colours to linear sRGB");
}

}  // namespace caustics

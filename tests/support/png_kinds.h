#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace caustics::support {

/// Every way in which PNG keeps pixels.
struct PngKind {
    enum class Colours { grey, palette, grey_alpha, rgb, rgb_alpha };

    Colours colours = Colours::rgb;
    int bits = 8;  ///< of one channel, or of an index into the palette
    bool interlaced = false;
    bool transparent =
        false;  ///< one colour (of a palette: its first entries) is marked as transparent
    bool has_gamma = false;  ///< says that its values are linear

    std::size_t channels() const;  ///< as kept: 1 of a palette
};

/// All kinds, with and without each mark.
std::vector<PngKind> all_png_kinds();

/// A PNG file of whole numbers below 2^bits, row by row from the top. Its palette is fixed.
std::string png_of_kind(const PngKind& kind, int width, int height,
                        const std::vector<std::uint16_t>& values);

}  // namespace caustics::support

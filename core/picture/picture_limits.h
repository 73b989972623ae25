#pragma once

#include <algorithm>
#include <cstddef>

#include "core/picture/picture_source.h"

namespace caustics {

/// As many pixels as a film may have.
inline constexpr std::size_t most_pixels = std::size_t{1} << 27;

/// As many as the file of a texture may have: 2^24, and more where a pixel has half a bit of the file.
constexpr std::size_t most_texture_pixels(std::size_t file_bytes) {
    constexpr std::size_t always = std::size_t{1} << 24;
    return std::min(most_pixels, std::max(always, 16 * file_bytes));
}

/// Memory that reading a texture may take, in the program and in the process that decodes: 220 MB for a file of up to
/// a megabyte.
constexpr std::size_t most_texture_memory(std::size_t file_bytes) {
    return std::max<std::size_t>(220'000'000, 209 * file_bytes);
}

/// Values of a row.
constexpr std::size_t row_values(const PictureShape& shape) {
    return static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.channels);
}

/// Rows that are decoded and handed over at a time. A film's are many whole blocks of an OpenEXR file, one for each
/// thread.
constexpr int rows_at_once(const PictureShape& shape) {
    constexpr std::size_t block = 32;
    const bool is_film = !shape.names.empty();
    const std::size_t most_values = is_film ? 1 << 22 : 1 << 18;
    const std::size_t rows = std::clamp<std::size_t>(most_values / row_values(shape), 1, 256);
    return static_cast<int>(is_film && rows > block ? rows - rows % block : rows);
}

}  // namespace caustics

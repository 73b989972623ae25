#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/picture/picture_source.h"

namespace caustics {

/// Whether these are the first bytes of a PNG file.
bool is_png(const std::string& bytes);

/// Opens a PNG of any kind by libpng; `bytes` must outlive it. Palettes become colours, transparent colours an alpha
/// channel. The pixels are decoded when rows are first asked for. Throws std::runtime_error.
std::unique_ptr<PictureSource> open_png(const std::string& bytes);

/// A PNG file of 8-bit pixels, 3 bytes each, row by row from the top. The same pixels give the same bytes.
std::string encode_png(int width, int height, const std::vector<unsigned char>& rgb);

}  // namespace caustics

#pragma once

#include <string>

namespace caustics {

/// The formats of pictures that are read, as an error names them.
inline constexpr const char* picture_formats =
    "PNG, OpenEXR, Radiance HDR, JPEG, TIFF, Targa and PNM";

/// The format of a picture's bytes by what they begin with, as OpenImageIO calls it: "png", "openexr", "hdr", "jpeg", "tiff",
/// "targa" or "pnm". Empty for everything else: OpenImageIO reads many more formats, and some of its readers write
/// outside their memory when a file is broken.
std::string picture_format(const std::string& bytes);

}  // namespace caustics

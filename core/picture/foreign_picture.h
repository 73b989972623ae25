#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/picture/picture_source.h"

namespace caustics {

/// Opens a picture of a format by OpenImageIO's name, with that reader alone; `bytes` are the whole file and must outlive it. The first
/// call loads the module with OpenImageIO, which takes a third of a second. Decodes from memory where the format can.
/// What the formats' own libraries print meanwhile is left out, since the error repeats it; so nothing else should
/// print at that time. Throws std::runtime_error with the reason: no picture, or no such module.
std::unique_ptr<PictureSource> open_foreign_picture(const std::filesystem::path& file,
                                                    const std::string& bytes,
                                                    const std::string& format);

/// What the module exports, under the name `open_picture_name`.
using OpenPicture = PictureSource* (*)(const char* file, const std::string& bytes,
                                       const std::string& format);
inline constexpr const char* open_picture_name = "caustics_open_picture";

}  // namespace caustics

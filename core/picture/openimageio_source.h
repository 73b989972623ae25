#pragma once

#include <memory>
#include <string>

#include "core/picture/picture_source.h"

namespace caustics {

/// Opens a picture of a format by OpenImageIO's name, with that reader alone; `bytes` are the whole file and must outlive it.
/// Throws std::runtime_error with the reason.
std::unique_ptr<PictureSource> open_with_openimageio(const std::string& bytes,
                                                     const std::string& format);

}  // namespace caustics

#pragma once

#include <filesystem>

#include "core/material/texture.h"

namespace caustics::support {

/// A picture's file, decoded by a process of its own.
inline Bitmap load_bitmap(const std::filesystem::path& file, bool raw) {
    PictureReader reader;
    return caustics::load_bitmap(reader, file, raw);
}

}  // namespace caustics::support

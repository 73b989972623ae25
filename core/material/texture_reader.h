#pragma once

#include "core/material/texture.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// A colour, or a `bitmap` or `checkerboard` texture.
Texture read_texture(const JsonNode& parent, const std::string& key, double fallback,
                     Assets& assets);

/// Colours and textures, with their keys.
Objects texture_keys();

}  // namespace caustics::scene_file

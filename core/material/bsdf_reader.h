#pragma once

#include "core/material/bsdf.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// Those that read_bsdf() knows.
const std::vector<std::string>& bsdf_types();
/// Whether it is one of them, or one that is refused by name.
bool is_bsdf_type(const std::string& type);
Bsdf read_bsdf(const JsonNode& node, Assets& assets);

/// All of them, with their keys.
Objects bsdf_keys();

}  // namespace caustics::scene_file

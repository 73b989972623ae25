#pragma once

#include "core/material/bsdf.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

bool is_bsdf_type(const std::string& type);
Bsdf read_bsdf(const JsonNode& node, Assets& assets);

}  // namespace caustics::scene_file

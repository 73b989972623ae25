#pragma once

#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// Keys that shapes share. Of every mesh, and with `resolution`: cells, cells that may differ along x and y,
/// sectors round an axis.
Keys mesh_keys();
Keys parametric_keys(const std::string& least);
Keys grid_keys();
Keys turned_keys(const std::string& resolution_of);

KeyText radius_key();
/// Its value, above 0; 1 without it.
double read_radius(const JsonNode& node);

}  // namespace caustics::scene_file

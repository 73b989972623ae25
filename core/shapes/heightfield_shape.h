#pragma once

#include <variant>

#include "core/exact_shapes/heightfield.h"
#include "core/geometry/height_grid.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// Whether a `heightfield` is heights at the corners of a grid, and not the exact sum of sines.
bool is_height_grid(const JsonNode& node);
/// Either, with the keys of both.
std::variant<SineHeightfield, HeightGrid> read_heights(const JsonNode& node, Assets& assets);

/// A heightfield and what is in it, with their keys.
Objects heightfield_keys();

}  // namespace caustics::scene_file

#pragma once

#include <optional>

#include "core/mesh/mesh.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// A `cut`, in its own frame. Only the smooth inside of a bowl takes a `resolution`.
TriangleMesh read_cut(const JsonNode& node, const std::optional<JsonNode>& resolution);

/// A cut solid and what is in it, with their keys.
Objects cut_keys();

}  // namespace caustics::scene_file

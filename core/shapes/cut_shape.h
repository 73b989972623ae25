#pragma once

#include <optional>

#include "core/geometry/mesh.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// A `cut`, in its own frame. Only the smooth inside of a bowl takes a `resolution`.
TriangleMesh read_cut(const JsonNode& node, const std::optional<JsonNode>& resolution);

}  // namespace caustics::scene_file

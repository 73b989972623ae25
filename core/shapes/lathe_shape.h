#pragma once

#include "core/geometry/lathe.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// The keys `profile`, `interpolation` and `segments` of an object.
LatheProfile read_profile(const JsonNode& node);
/// A `lathe`, in its own frame; `open` is read here as well.
TriangleMesh read_lathe(const JsonNode& node, int sectors);

}  // namespace caustics::scene_file

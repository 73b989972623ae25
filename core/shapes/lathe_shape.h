#pragma once

#include "core/geometry/lathe.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

/// The keys `profile`, `interpolation` and `segments` of an object.
LatheProfile read_profile(const JsonNode& node);
/// A `lathe`, in its own frame; `open` is read here as well.
TriangleMesh read_lathe(const JsonNode& node, int sectors);

Keys profile_keys();
/// A lathe and what is in it, with their keys.
Objects lathe_keys();

}  // namespace caustics::scene_file

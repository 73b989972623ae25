#pragma once

#include <cstdint>
#include <filesystem>

#include "tests/cruel/parts.h"

namespace caustics::cruel {

/// The JSON of a random scene that the program must take; its meshes and pictures are written into the
/// folder, where the scene's file belongs too. The same seed gives the same scene. Its receiver `floor`
/// is a rectangle.
Json cruel_scene(Purpose purpose, std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace caustics::cruel

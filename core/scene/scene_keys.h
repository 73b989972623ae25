#pragma once

#include <vector>

#include "core/base/key_text.h"

namespace caustics::scene_file {

/// Every object that the readers of scene files know (scene_io, shapes, bsdfs, values), with its keys.
const std::vector<ObjectText>& scene_keys();

}  // namespace caustics::scene_file

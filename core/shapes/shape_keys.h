#pragma once

#include "core/scene_file/key_texts.h"

namespace caustics::scene_file {

/// The shapes and what is in them, with their keys.
Objects shape_keys();

}  // namespace caustics::scene_file

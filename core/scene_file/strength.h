#pragma once

#include "core/math/spectrum.h"
#include "core/scene_file/json_reader.h"
#include "core/scene_file/key_texts.h"

namespace caustics::scene_file {

/// The colour of what a light sends, 1 without the key. Each channel is 0, or 1e-30 to 1e30: a path has
/// about 1e-8 of it, which a float still holds to five digits.
Spectrum read_strength(const JsonNode& parent, const std::string& key);
/// Its text in the list of keys.
KeyText strength(const std::string& key, const std::string& meaning, const std::string& unit);

}  // namespace caustics::scene_file

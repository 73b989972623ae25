#pragma once

#include <string>
#include <vector>

#include "core/base/key_text.h"

namespace caustics::scene_file {

/// Texts of keys, by the kind of their value: what scene_keys() is made of. A key without `usual` has to be
/// given.

using Keys = std::vector<KeyText>;
using Objects = std::vector<ObjectText>;

KeyText type_key();
KeyText transform(const std::string& meaning);
KeyText number(const std::string& key, const std::string& meaning, const std::string& unit,
               const std::string& usual, const std::string& range);
KeyText whole(const std::string& key, const std::string& meaning, const std::string& unit,
              const std::string& usual, const std::string& range);
KeyText vector(const std::string& key, const std::string& meaning, const std::string& usual);
KeyText yes_or_no(const std::string& key, const std::string& meaning, const std::string& usual);
KeyText colour(const std::string& key, const std::string& meaning, const std::string& unit,
               const std::string& usual, const std::string& range);
KeyText texture(const std::string& key, const std::string& meaning, const std::string& usual);
KeyText choice(const std::string& key, const std::string& meaning, const std::string& usual,
               const std::string& choices);
KeyText file(const std::string& meaning);

}  // namespace caustics::scene_file

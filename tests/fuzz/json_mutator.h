#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/key_text.h"

namespace caustics::fuzz {

/// Words that a kind of file knows: keys, types, choices.
std::vector<std::string> words_of(const std::vector<ObjectText>& objects);

/// Changes a JSON text by its structure: renames, retypes, doubles, nests, swaps and removes values, and
/// puts extremes in the place of numbers; now and then, and where the text is no JSON, by its bytes.
/// For LLVMFuzzerCustomMutator, whose arguments these are. Returns the new size.
std::size_t mutate_json(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                        const std::vector<std::string>& words);

/// Puts a value of the second text into the first. For LLVMFuzzerCustomCrossOver.
std::size_t cross_json(const std::string& first, const std::string& second, std::uint8_t* out,
                       std::size_t most, unsigned seed);

/// Whether values under such keys (key -> most) ask for more, within what readers take: valid, but much work
/// or memory. Texts that are no JSON ask for nothing.
bool asks_for_much(std::string_view text, const std::map<std::string, double>& most);

}  // namespace caustics::fuzz

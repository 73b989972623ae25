#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace caustics::fuzz {

/// Changes a text by its words and lines: puts known words and awkward numbers in the place of others, doubles,
/// moves and removes; now and then by its bytes. For LLVMFuzzerCustomMutator, whose arguments these are.
std::size_t mutate_words(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                         const std::vector<std::string>& known);

}  // namespace caustics::fuzz

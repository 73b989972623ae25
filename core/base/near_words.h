#pragma once

#include <string>
#include <vector>

namespace caustics {

/// The words of `known` that are nearest to a misspelt word: at most two letters are inserted, left out,
/// replaced or swapped with their neighbour. Capital letters count as small ones. Empty where no word is near.
std::vector<std::string> near_words(const std::string& word, const std::vector<std::string>& known);

/// ": did you mean hybrid or single?", for a message that names an unknown word; empty where no word is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

}  // namespace caustics

#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace caustics {

/// ASCII letters made small, as names of files and glasses are compared.
inline std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The element of `words` that is the word itself, or else is the word where capital letters count as small ones.
inline std::vector<std::string>::const_iterator find_word(const std::vector<std::string>& words,
                                                          const std::string& word) {
    const auto itself = std::ranges::find(words, word);
    if (itself != words.end()) return itself;
    return std::ranges::find(words, lower_case(word),
                             [](const std::string& each) { return lower_case(each); });
}

}  // namespace caustics

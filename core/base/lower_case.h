#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace caustics {

/// ASCII letters made small, as names of files and glasses are compared.
inline std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

}  // namespace caustics

#pragma once

#include <string>
#include <string_view>

namespace caustics {

/// A word of a file, for a message: in quotes, cut to 40 characters, what is not ASCII to print as '?'.
inline std::string quoted_word(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return "'" + text + "'";
}

}  // namespace caustics

#pragma once

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

namespace caustics::support {

/// The words that a message on an unknown key lists as known: `... (known: "a", "b")`, before what it says of
/// names of their own behind a semicolon. None where it lists none.
inline std::set<std::string> known_words(const std::string& message) {
    const std::size_t start = message.rfind("(known: ");
    if (start == std::string::npos) return {};
    std::string list = message.substr(start + 8, message.size() - start - 9);
    list = list.substr(0, list.find(';'));
    std::ranges::replace(list, ',', ' ');
    std::erase(list, '"');
    std::istringstream words(list);
    return {std::istream_iterator<std::string>(words), {}};
}

}  // namespace caustics::support

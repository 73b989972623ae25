#include "experiments/base/bounded_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

constexpr int most_levels = 64;

/// Of arrays and objects in JSON text; in other text, some number.
int nesting(const std::string& text) {
    int levels = 0;
    int most = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') quoted = !quoted;
        if (quoted) {
            if (c == '\\') ++i;
        } else if (c == '[' || c == '{') {
            most = std::max(most, ++levels);
        } else if (c == ']' || c == '}') {
            --levels;
        }
    }
    return most;
}

/// The library would take a NUL for the end of the text, whatever follows.
bool holds_nul(const std::string& text) { return text.find('\0') != std::string::npos; }

}  // namespace

json parse_bounded(const std::string& text) {
    if (nesting(text) > most_levels)
        throw InputError(fmt::format("nested more than {} levels deep", most_levels));
    if (holds_nul(text)) throw InputError("holds a NUL byte, which JSON has not");
    return json::parse(text);
}

json parse_bounded_or_discard(const std::string& text) {
    if (nesting(text) > most_levels || holds_nul(text)) return json(json::value_t::discarded);
    return json::parse(text, nullptr, false);
}

}  // namespace caustics::experiments

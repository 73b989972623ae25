#include "experiments/base/shell_word.h"

#include <fmt/format.h>

#include <algorithm>

namespace caustics::experiments {

namespace {

bool is_control(char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }

std::string quoted(const std::string& text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

/// Control characters in the octal digits that printf(1) reads; what it would read besides doubled.
std::string printf_format(const std::string& text) {
    std::string format;
    for (const char c : text) {
        if (is_control(c))
            format += fmt::format("\\{:03o}", static_cast<int>(c));
        else
            format += std::string(c == '\\' || c == '%' ? 2 : 1, c);
    }
    return format;
}

}  // namespace

std::string shell_word(const std::string& text) {
    const bool plain = text.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                           "_-./=:,+") == std::string::npos;
    if (plain && !text.empty()) return text;
    if (std::ranges::none_of(text, is_control)) return quoted(text);
    return fmt::format("\"$(printf {})\"", quoted(printf_format(text)));
}

std::string shell_path(const std::filesystem::path& file) {
    const std::string name = file.string();
    return shell_word(name.starts_with('-') ? "./" + name : name);
}

}  // namespace caustics::experiments

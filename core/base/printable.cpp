#include "core/base/printable.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace caustics {
namespace {

constexpr std::size_t longest_word = 500;
constexpr std::size_t longest_line = 2000;

unsigned byte_at(std::string_view text, std::size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
}

bool continues(std::string_view text, std::size_t at) {
    return (byte_at(text, at) & 0xC0U) == 0x80;
}

/// Bytes of the character that begins at `at`; 0 where none does.
std::size_t character_length(std::string_view text, std::size_t at) {
    const unsigned first = byte_at(text, at);
    const unsigned second = byte_at(text, at + 1);
    if (first < 0x80) return 1;
    if (first < 0xC2 || first > 0xF4 || !continues(text, at + 1)) return 0;
    if (first < 0xE0) return 2;
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0)) return 0;
    if (!continues(text, at + 2)) return 0;
    if (first < 0xF0) return 3;
    if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90)) return 0;
    return continues(text, at + 3) ? 4 : 0;
}

bool is_control(std::string_view character) {
    const unsigned first = byte_at(character, 0);
    return first < 0x20 || first == 0x7F || (first == 0xC2 && byte_at(character, 1) < 0xA0);
}

std::string visible(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const std::size_t length = character_length(text, 0);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        if (character == "\n" || character == "\t" || character == "\r")
            shown += ' ';
        else if (length == 0 || is_control(character))
            shown += '?';
        else
            shown += character;
        text.remove_prefix(character.size());
    }
    while (!shown.empty() && shown.back() == ' ') shown.pop_back();
    return shown;
}

/// Beginning and end of what is longer than `most` bytes; no character is cut.
std::string without_middle(std::string_view text, std::size_t most) {
    if (text.size() <= most) return std::string(text);
    std::size_t head = most / 2;
    std::size_t tail = text.size() - most / 2;
    while (continues(text, head)) --head;
    while (continues(text, tail)) ++tail;
    return std::string(text.substr(0, head)) + "..." + std::string(text.substr(tail));
}

}  // namespace

std::string one_line(std::string_view text) {
    const std::string shown = visible(text);
    std::string line;
    for (std::size_t from = 0; from < shown.size();) {
        const std::size_t to = std::min(shown.find(' ', from), shown.size());
        line += without_middle(std::string_view(shown).substr(from, to - from), longest_word);
        if (to < shown.size()) line += ' ';
        from = to + 1;
    }
    return without_middle(line, longest_line);
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = character_length(text, at);
        if (length == 0) return false;
        at += length;
    }
    return true;
}

}  // namespace caustics

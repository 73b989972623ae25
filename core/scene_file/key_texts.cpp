#include "core/scene_file/key_texts.h"

namespace caustics::scene_file {

KeyText type_key() {
    return {.key = "type", .meaning = "Says what the object is: the name above.", .type = "word"};
}

KeyText transform(const std::string& meaning) {
    return {.key = "to_world", .meaning = meaning, .type = "transform", .usual = "[]"};
}

KeyText number(const std::string& key, const std::string& meaning, const std::string& unit,
               const std::string& usual, const std::string& range) {
    return {.key = key,
            .meaning = meaning,
            .unit = unit,
            .type = "number",
            .usual = usual,
            .choices = range};
}

KeyText whole(const std::string& key, const std::string& meaning, const std::string& unit,
              const std::string& usual, const std::string& range) {
    KeyText text = number(key, meaning, unit, usual, range);
    text.type = "whole number";
    return text;
}

KeyText vector(const std::string& key, const std::string& meaning, const std::string& usual) {
    return {.key = key, .meaning = meaning, .unit = "m", .type = "[x, y, z]", .usual = usual};
}

KeyText yes_or_no(const std::string& key, const std::string& meaning, const std::string& usual) {
    return {.key = key, .meaning = meaning, .type = "true or false", .usual = usual};
}

KeyText colour(const std::string& key, const std::string& meaning, const std::string& unit,
               const std::string& usual, const std::string& range) {
    return {.key = key,
            .meaning = meaning,
            .unit = unit,
            .type = "colour",
            .usual = usual,
            .choices = range};
}

KeyText texture(const std::string& key, const std::string& meaning, const std::string& usual) {
    return {.key = key,
            .meaning = meaning,
            .type = "colour or texture",
            .usual = usual,
            .choices = "0 to 1"};
}

KeyText choice(const std::string& key, const std::string& meaning, const std::string& usual,
               const std::string& choices) {
    return {.key = key, .meaning = meaning, .type = "choice", .usual = usual, .choices = choices};
}

KeyText file(const std::string& meaning) {
    return {.key = "filename", .meaning = meaning, .type = "file"};
}

}  // namespace caustics::scene_file

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <nlohmann/json.hpp>

namespace caustics {

/// What the JsonNodes of one document share. Only json_reader.cpp and json_document.cpp see it.
struct JsonDocument {
    /// The keys of one object that its reader asked for.
    struct Keys {
        std::vector<const std::string*> known;  ///< by name, in the order of asking; of `names`
        std::unordered_set<const std::string*> taken;  ///< as children of any name; of the object
        bool takes_objects = false;                    ///< of any name
    };

    nlohmann::json root;
    std::filesystem::path file;        ///< as messages name it
    std::filesystem::path written_in;  ///< the file, where `file` names a place in it
    /// Where a value came from another file: its pointer -> that file.
    std::map<std::string, std::filesystem::path> included;
    std::vector<std::filesystem::path> files_included;  ///< all, also where others took their place
    std::unordered_map<const nlohmann::json*, Keys> keys;  ///< by the object
    std::unordered_set<std::string> names;                 ///< all keys that readers asked for

    /// The entry of `keys` for an object; a reader asks one object many times in a row.
    Keys& asked_of(const nlohmann::json* object);
    const nlohmann::json* last_object = nullptr;  ///< that asked_of() was called with
    Keys* last_asked = nullptr;

    bool is_known(const nlohmann::json* object, const std::string& key);
    void make_known(const nlohmann::json* object, const std::string& key);
    /// The keys that the object's reader asked for.
    std::vector<std::string> known_keys(const nlohmann::json* object);
    /// Forgets the keys that were asked for in a value which another one is about to replace.
    void forget_keys(const nlohmann::json& value);

    /// The entry of `included` at or above a pointer, nearest first; end() for the main file.
    std::map<std::string, std::filesystem::path>::const_iterator inclusion(
        const std::string& pointer) const;
    /// "file: /pointer", with the pointer inside that file and, when included, the whole one.
    std::string place(const std::string& pointer) const;
    [[noreturn]] void fail(const std::string& pointer, const std::string& reason) const;
};

/// Appends a key to a pointer, escaped as RFC 6901 says.
std::string child_pointer(const std::string& pointer, const std::string& key);
/// A key or value as JSON text on one line, cut to a readable length.
std::string shown(const nlohmann::json& value);
/// The keys of an object; none of any other value.
std::vector<std::string> keys_of(const nlohmann::json& value);
/// "a, b", or a word for none.
std::string key_list(const nlohmann::json& object);
std::string join(const std::vector<std::string>& words);

/// Parses text strictly: one value, no duplicate keys, bounded nesting. Throws InputError naming
/// `origin` and the line and column or the pointer.
nlohmann::json parse_json(const std::string& text, const std::string& origin);
/// Replaces every `{"$include": ...}` in `value`, which stands at `pointer` of the document and was
/// written in `file`, and notes in the document where the replacements came from.
void resolve_includes(nlohmann::json& value, const std::string& pointer,
                      const std::filesystem::path& file, JsonDocument& document);
/// Text that is the same for the same values: sorted keys, shortest round-trip numbers, 1.0 as 1.
std::string canonical_json(const nlohmann::json& value);

}  // namespace caustics

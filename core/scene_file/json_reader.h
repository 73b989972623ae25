#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace caustics {

struct JsonDocument;

/// A value of a JSON document with its place, read strictly: every access says what it expects,
/// every key of an object must be asked for, and what does not fit throws InputError as
/// "file: /pointer: reason (alternatives)". Cheap to copy; keeps the document alive.
class JsonNode {
public:
    /// Parses a file; duplicate keys are errors. `{"$include": "file.json"}` is replaced by that
    /// file's content (paths relative to the including file) and errors name the included file.
    static JsonNode parse_file(const std::filesystem::path& file);
    /// Parses text that did not come from a file, or is part of the file `written_in`; `origin`
    /// stands for the file in messages.
    static JsonNode parse_text(const std::string& text, const std::string& origin,
                               const std::filesystem::path& written_in = {});

    /// Replaces the value at a JSON pointer of RFC 6901 ("/water/resolution"), or adds its last key
    /// to an existing object. `value` is JSON, or else taken as a string. Of the whole document,
    /// whatever node it is called on; call it before reading: nodes in what it replaces are not valid any more.
    void set(const std::string& pointer, const std::string& value);

    bool is_object() const;
    bool is_array() const;
    bool is_number() const;
    bool is_string() const;
    bool is_bool() const;

    double as_number() const;  ///< finite
    double as_number_in(double low, double high) const;
    /// A whole number, or text that suffixed_count() reads: "100k".
    std::int64_t as_integer_in(std::int64_t low, std::int64_t high) const;
    bool as_bool() const;
    std::string as_string() const;
    /// The index of the string among the choices; capital letters count as small ones.
    std::size_t as_choice(const std::vector<std::string>& choices) const;
    std::vector<double> as_numbers(std::size_t count) const;  ///< an array of so many numbers
    std::vector<JsonNode> as_array() const;

    /// Whether an object has the key; leaves it unknown.
    bool has(const std::string& key) const;
    /// The child of an object; marks the key as known whether present or not.
    std::optional<JsonNode> find(const std::string& key) const;
    /// As find, but the key must be there.
    JsonNode at(const std::string& key) const;
    /// The children not yet asked for, in the order of their keys; marks them.
    std::vector<std::pair<std::string, JsonNode>> others() const;
    /// As others, but only the children that are objects; the rest is left to be asked for.
    std::vector<std::pair<std::string, JsonNode>> children() const;
    /// Throws unless every key was asked for, listing those that are known.
    void finish() const;

    [[noreturn]] void fail(const std::string& reason) const;
    /// "file: /pointer", where the pointer is that inside the file.
    std::string place() const;
    /// The file this value was written in; relative names inside are relative to its folder.
    std::filesystem::path file() const;
    /// The document's file and all that it includes.
    std::vector<std::filesystem::path> files() const;
    /// The value as messages show it: cut where it is long.
    std::string words() const;
    /// Canonical text: sorted keys, shortest round-trip numbers.
    std::string canonical() const;

private:
    explicit JsonNode(std::shared_ptr<JsonDocument> document);
    JsonNode(const JsonNode& parent, const std::string& key, const nlohmann::json& value);
    std::vector<std::pair<std::string, JsonNode>> take(bool objects_alone) const;
    std::filesystem::path file_at(const std::string& pointer) const;
    [[noreturn]] void fail_for_missing(const std::string& key) const;
    std::shared_ptr<JsonDocument> document_;
    std::string pointer_;
    const nlohmann::json* value_;  ///< of the document
};

}  // namespace caustics

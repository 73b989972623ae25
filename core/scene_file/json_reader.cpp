#include "core/scene_file/json_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/base/atomic_file.h"
#include "core/base/decimal.h"
#include "core/base/error.h"
#include "core/base/lower_case.h"
#include "core/base/near_words.h"
#include "core/scene_file/json_document.h"

namespace caustics {
namespace {

using nlohmann::json;

/// The tokens of a JSON pointer; empty when it is not one.
std::vector<std::string> pointer_tokens(const std::string& pointer) {
    try {
        json::json_pointer rest(pointer);
        std::vector<std::string> tokens;
        for (; !rest.empty(); rest.pop_back()) tokens.push_back(rest.back());
        std::reverse(tokens.begin(), tokens.end());
        return tokens;
    } catch (const json::exception&) {
        return {};
    }
}

/// The element of an array that a pointer's token names, or nullptr.
json* element(json& array, const std::string& token) {
    std::size_t index = 0;
    const char* end = token.data() + token.size();
    const auto parsed = std::from_chars(token.data(), end, index);
    const bool leading_zero = token.size() > 1 && token[0] == '0';
    if (parsed.ec != std::errc() || parsed.ptr != end || leading_zero || index >= array.size())
        return nullptr;
    return &array[index];
}

bool is_finite_number(const json& value) {
    return value.is_number() && std::isfinite(value.get<double>());
}

std::string contents(const json& value) {
    if (value.is_object()) return "is an object with the keys: " + key_list(value);
    if (value.is_array()) return fmt::format("is an array of {} elements", value.size());
    return "is " + shown(value);
}

json value_or_string(const std::string& text, const std::string& place) {
    if (json::accept(text)) return parse_json(text, place);
    if (const std::optional<double> number = decimal<double>(text)) return *number;
    if (!is_utf8(text)) throw InputError(place + ": the value is not valid UTF-8");
    return parse_json(json(text).dump(), place);
}

}  // namespace

JsonNode::JsonNode(std::shared_ptr<JsonDocument> document)
    : document_(std::move(document)), value_(&document_->root) {}

JsonNode::JsonNode(const JsonNode& parent, const std::string& key, const json& value)
    : document_(parent.document_), pointer_(child_pointer(parent.pointer_, key)), value_(&value) {}

JsonNode JsonNode::parse_file(const std::filesystem::path& file) {
    const auto document = std::make_shared<JsonDocument>();
    document->file = file;
    document->root = parse_json(read_whole_file(file), file.string());
    resolve_includes(document->root, "", file, *document);
    return JsonNode(document);
}

JsonNode JsonNode::parse_text(const std::string& text, const std::string& origin,
                              const std::filesystem::path& written_in) {
    const auto document = std::make_shared<JsonDocument>();
    document->file = origin;
    document->written_in = written_in;
    document->root = parse_json(text, origin);
    return JsonNode(document);
}

void JsonNode::set(const std::string& pointer, const std::string& value) {
    const std::string what = fmt::format("{}: setting {}", document_->file.string(), pointer);
    const std::vector<std::string> tokens = pointer_tokens(pointer);
    if (tokens.empty())
        throw InputError(what + ": not a JSON pointer, which looks like /water/resolution");
    json* target = &document_->root;
    std::string reached;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        json* next = nullptr;
        if (target->is_array()) {
            next = element(*target, tokens[i]);
        } else if (target->is_object()) {
            if (target->contains(tokens[i]) || i + 1 == tokens.size()) next = &(*target)[tokens[i]];
        }
        if (next == nullptr)
            throw InputError(fmt::format("{}: there is nothing of that name{}; {} {}", what,
                                         did_you_mean(tokens[i], keys_of(*target)),
                                         reached.empty() ? "/" : reached, contents(*target)));
        target = next;
        reached = child_pointer(reached, tokens[i]);
    }
    std::erase_if(document_->included, [&](const auto& entry) {
        return entry.first == reached || entry.first.starts_with(reached + "/");
    });
    document_->forget_keys(*target);
    *target = value_or_string(value, what);
    resolve_includes(*target, reached, file_at(reached), *document_);
}

bool JsonNode::is_object() const { return value_->is_object(); }
bool JsonNode::is_array() const { return value_->is_array(); }
bool JsonNode::is_number() const { return value_->is_number(); }
bool JsonNode::is_string() const { return value_->is_string(); }
bool JsonNode::is_bool() const { return value_->is_boolean(); }

std::string JsonNode::words() const { return shown(*value_); }

double JsonNode::as_number() const {
    const json& value = *value_;
    if (!value.is_number()) fail("expected a number, got " + shown(value));
    const double number = value.get<double>();
    if (!std::isfinite(number)) fail("expected a finite number");
    return number;
}

double JsonNode::as_number_in(double low, double high) const {
    const double number = as_number();
    if (number < low || number > high)
        fail(fmt::format("{} is out of range (from {} to {})", number, low, high));
    return number;
}

std::int64_t JsonNode::as_integer_in(std::int64_t low, std::int64_t high) const {
    const json& value = *value_;
    const std::string range = fmt::format("is out of range (from {} to {})", low, high);
    if (value.is_string()) {
        const auto count = suffixed_count(value.get_ref<const std::string&>());
        if (!count) fail("expected a whole number, got " + shown(value));
        if (*count < low || *count > high) fail(shown(value) + " " + range);
        return *count;
    }
    if (!value.is_number()) fail("expected a whole number, got " + shown(value));
    if (value.is_number_float()) {
        // 1e6 is a whole number too; beyond 2^53 a double no longer says which one.
        const double number = value.get<double>();
        if (std::trunc(number) != number) fail("expected a whole number, got " + shown(value));
        if (std::abs(number) > 9007199254740992.0) fail(shown(value) + " " + range);
        const auto integer = static_cast<std::int64_t>(number);
        if (integer < low || integer > high) fail(shown(value) + " " + range);
        return integer;
    }
    const bool too_big =
        value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{INT64_MAX};
    if (too_big || value.get<std::int64_t>() < low || value.get<std::int64_t>() > high)
        fail(shown(value) + " " + range);
    return value.get<std::int64_t>();
}

bool JsonNode::as_bool() const {
    if (!is_bool()) fail("expected true or false, got " + words());
    return value_->get<bool>();
}

std::string JsonNode::as_string() const {
    if (!is_string()) fail("expected a string, got " + words());
    return value_->get<std::string>();
}

std::size_t JsonNode::as_choice(const std::vector<std::string>& choices) const {
    const json& value = *value_;
    const auto found =
        value.is_string() ? find_word(choices, value.get_ref<const std::string&>()) : choices.end();
    if (found == choices.end())
        fail(fmt::format("{} is none of the choices{} ({})", shown(value),
                         value.is_string() ? did_you_mean(value.get<std::string>(), choices) : "",
                         join(choices)));
    return static_cast<std::size_t>(found - choices.begin());
}

std::vector<double> JsonNode::as_numbers(std::size_t count) const {
    const json& value = *value_;
    if (!value.is_array() || value.size() != count)
        fail(fmt::format("expected an array of {} numbers, got {}", count, shown(value)));
    std::vector<double> numbers;
    numbers.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        numbers.push_back(is_finite_number(value[i])
                              ? value[i].get<double>()
                              : JsonNode(*this, std::to_string(i), value[i]).as_number());
    return numbers;
}

std::vector<JsonNode> JsonNode::as_array() const {
    const json& value = *value_;
    if (!value.is_array()) fail("expected an array, got " + shown(value));
    std::vector<JsonNode> nodes;
    nodes.reserve(value.size());
    for (std::size_t i = 0; i < value.size(); ++i)
        nodes.push_back(JsonNode(*this, std::to_string(i), value[i]));
    return nodes;
}

bool JsonNode::has(const std::string& key) const {
    const json& value = *value_;
    if (!value.is_object()) fail("expected an object, got " + shown(value));
    return value.contains(key);
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
    const json& value = *value_;
    if (!value.is_object()) fail("expected an object, got " + shown(value));
    document_->make_known(value_, key);
    const auto child = value.find(key);
    if (child == value.end()) return std::nullopt;
    return JsonNode(*this, key, *child);
}

JsonNode JsonNode::at(const std::string& key) const {
    const std::optional<JsonNode> child = find(key);
    if (!child) fail_for_missing(key);
    return *child;
}

void JsonNode::fail_for_missing(const std::string& key) const {
    const std::vector<std::string> present = keys_of(*value_);
    std::vector<std::string> unknown;
    std::ranges::copy_if(present, std::back_inserter(unknown), [&](const std::string& each) {
        return !document_->is_known(value_, each);
    });
    const std::vector<std::string> near = near_words(key, unknown);
    fail(
        fmt::format("key {} is missing{} (present: {})", shown(key),
                    near.empty() ? "" : fmt::format(": is {} meant to be it?", shown(near.front())),
                    join(present)));
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::take(bool objects_alone) const {
    const json& value = *value_;
    if (!value.is_object()) fail("expected an object, got " + shown(value));
    JsonDocument::Keys& keys = document_->asked_of(value_);
    std::vector<std::pair<std::string, JsonNode>> nodes;
    for (const auto& [key, child] : value.get_ref<const json::object_t&>()) {
        if (objects_alone && !child.is_object()) continue;
        if (document_->is_known(value_, key)) continue;
        if (!keys.taken.insert(&key).second) continue;
        nodes.emplace_back(key, JsonNode(*this, key, child));
    }
    return nodes;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::others() const { return take(false); }

std::vector<std::pair<std::string, JsonNode>> JsonNode::children() const {
    document_->asked_of(value_).takes_objects = true;
    return take(true);
}

void JsonNode::finish() const {
    const json& value = *value_;
    if (!value.is_object()) fail("expected an object, got " + shown(value));
    const JsonDocument::Keys& keys = document_->asked_of(value_);
    for (const auto& [key, child] : value.get_ref<const json::object_t&>()) {
        if (document_->is_known(value_, key) || keys.taken.contains(&key)) continue;
        const std::vector<std::string> known = document_->known_keys(value_);
        fail(fmt::format(
            "unknown key {}{} (known: {}{})", shown(key), did_you_mean(key, known), join(known),
            keys.takes_objects
                ? "; with a name of its own: an object with a type, not " + shown(child)
                : ""));
    }
}

void JsonNode::fail(const std::string& reason) const { document_->fail(pointer_, reason); }

std::string JsonNode::place() const { return document_->place(pointer_); }

std::filesystem::path JsonNode::file() const { return file_at(pointer_); }

std::filesystem::path JsonNode::file_at(const std::string& pointer) const {
    const auto inclusion = document_->inclusion(pointer);
    if (inclusion != document_->included.end()) return inclusion->second;
    return document_->written_in.empty() ? document_->file : document_->written_in;
}

std::vector<std::filesystem::path> JsonNode::files() const {
    std::vector<std::filesystem::path> all{document_->file};
    all.insert(all.end(), document_->files_included.begin(), document_->files_included.end());
    return all;
}

std::string JsonNode::canonical() const { return canonical_json(*value_); }

}  // namespace caustics

#include "core/json_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.h"

namespace caustics {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text.empty() ? "none" : text;
}

std::string escaped(std::string key) {
    const auto replace_all = [&key](char from, const char* to) {
        for (std::size_t at = 0; (at = key.find(from, at)) != std::string::npos; at += 2)
            key.replace(at, 1, to);
    };
    replace_all('~', "~0");
    replace_all('/', "~1");
    return key;
}

// Where a byte of a text stands, for people.
std::string line_and_column(const std::string& text, std::size_t byte) {
    std::size_t line = 1;
    std::size_t column = 1;
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
        column = text[i] == '\n' ? 1 : column + 1;
        line += text[i] == '\n' ? 1 : 0;
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// nlohmann keeps the last of two equal keys in silence; this names the first such key.
class DuplicateKeys {
public:
    bool operator()(int, Json::parse_event_t event, Json& value) {
        if (event == Json::parse_event_t::object_start) open_.emplace_back();
        if (event == Json::parse_event_t::object_end) open_.pop_back();
        if (event == Json::parse_event_t::key &&
            !open_.back().insert(value.get<std::string>()).second && first_.empty())
            first_ = value.get<std::string>();
        return true;
    }
    const std::string& first() const { return first_; }

private:
    std::vector<std::set<std::string>> open_;
    std::string first_;
};

Json parse(const std::string& text, const std::string& origin) {
    DuplicateKeys duplicates;
    Json json;
    try {
        json = Json::parse(text, std::ref(duplicates));
    } catch (const Json::parse_error& error) {
        throw InputError(origin + ": not JSON at " + line_and_column(text, error.byte));
    } catch (const Json::exception&) {
        throw InputError(origin + ": a number is out of range");
    }
    if (!duplicates.first().empty())
        throw InputError(origin + ": key \"" + duplicates.first() + "\" stands twice in one object");
    return json;
}

// Replaces every {"$include": "file"} by that file's content and notes where it came from.
class Includer {
public:
    explicit Includer(std::map<std::string, fs::path>& files) : files_(files) {}

    Json load(const fs::path& file, const std::string& pointer) {
        if (std::ranges::find(open_, file) != open_.end())
            throw InputError(file.string() + ": $include comes back to this file");
        std::ifstream in(file, std::ios::binary);
        std::ostringstream text;
        if (!in || fs::is_directory(file) || !(text << in.rdbuf()))
            throw InputError(file.string() + ": cannot be read" + including());
        Json json = parse(text.str(), file.string());
        open_.push_back(file);
        files_[pointer] = file;
        resolve(json, pointer);
        open_.pop_back();
        return json;
    }

private:
    std::string including() const {
        return open_.empty() ? "" : " (included by " + open_.back().string() + ")";
    }

    void resolve(Json& json, const std::string& pointer) {
        if (json.is_array())
            for (std::size_t i = 0; i < json.size(); ++i)
                resolve(json[i], pointer + "/" + std::to_string(i));
        if (!json.is_object()) return;
        if (const auto include = json.find("$include"); include != json.end()) {
            const std::string place = open_.back().string() + ": " + pointer;
            if (!include->is_string()) throw InputError(place + ": $include takes a file's name");
            if (json.size() > 1)
                throw InputError(place + ": no other key may stand beside $include");
            json = load(open_.back().parent_path() / include->get<std::string>(), pointer);
            return;
        }
        for (auto& [key, child] : json.items()) resolve(child, pointer + "/" + escaped(key));
    }

    std::map<std::string, fs::path>& files_;
    std::vector<fs::path> open_;
};

const char* kind_of(const Json& json) {
    switch (json.type()) {
        case Json::value_t::object: return "an object";
        case Json::value_t::array: return "a list";
        case Json::value_t::string: return "a string";
        case Json::value_t::boolean: return "true or false";
        case Json::value_t::null: return "null";
        default: return "a number";
    }
}

std::vector<std::string> keys_of(const Json& json) {
    std::vector<std::string> keys;
    for (const auto& [key, child] : json.items()) keys.push_back(key);
    return keys;
}

std::string number_text(double value) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << value;
    return text.str();
}

}  // namespace

struct JsonNode::Document {
    Json root;
    std::map<std::string, fs::path> files;               ///< pointer -> file written there
    std::map<std::string, std::set<std::string>> known;  ///< pointer of an object -> keys asked for

    const Json& at(const std::string& pointer) const { return root.at(Json::json_pointer(pointer)); }
};

JsonNode::JsonNode(std::shared_ptr<Document> document, std::string pointer)
    : document_(std::move(document)), pointer_(std::move(pointer)) {}

JsonNode JsonNode::parse_file(const fs::path& file) {
    auto document = std::make_shared<Document>();
    document->root = Includer(document->files).load(file, "");
    return {document, ""};
}

JsonNode JsonNode::parse_text(const std::string& text, const std::string& origin) {
    auto document = std::make_shared<Document>();
    document->files[""] = origin;
    document->root = parse(text, origin);
    return {document, ""};
}

void JsonNode::set(const std::string& pointer, const std::string& value) {
    const auto refuse = [&](const std::string& reason) {
        throw InputError(file().string() + ": " + pointer + ": " + reason);
    };
    if (pointer.empty() || pointer.front() != '/')
        refuse("not a JSON pointer: it starts with / (as in /water/resolution)");
    const Json parsed = Json::parse(value, nullptr, false);
    const Json replacement = parsed.is_discarded() ? Json(value) : parsed;
    try {
        Json::json_pointer path(pointer);
        const std::string last = path.back();
        std::string reached;
        Json* parent = &document_->root;
        std::istringstream parts(pointer.substr(1, pointer.rfind('/') > 0 ? pointer.rfind('/') - 1
                                                                          : 0));
        for (std::string part; std::getline(parts, part, '/');) {
            const Json::json_pointer next("/" + part);
            if (!parent->contains(next))
                refuse("points into nothing: " + (reached.empty() ? "the root" : reached) +
                       " has no \"" + part + "\" (it has: " + joined(keys_of(*parent)) + ")");
            parent = &parent->at(next);
            reached += "/" + part;
        }
        const bool fits = parent->is_object() ||
                          (parent->is_array() && parent->contains(Json::json_pointer("/" + last)));
        if (!fits)
            refuse("points into nothing: " + (reached.empty() ? "the root" : reached) + " is " +
                   kind_of(*parent));
        document_->root[path] = replacement;
    } catch (const Json::exception&) {
        refuse("not a JSON pointer into this file");
    }
}

bool JsonNode::is_object() const { return document_->at(pointer_).is_object(); }
bool JsonNode::is_array() const { return document_->at(pointer_).is_array(); }
bool JsonNode::is_number() const { return document_->at(pointer_).is_number(); }
bool JsonNode::is_string() const { return document_->at(pointer_).is_string(); }
bool JsonNode::is_bool() const { return document_->at(pointer_).is_boolean(); }

double JsonNode::as_number() const {
    const Json& json = document_->at(pointer_);
    if (!json.is_number()) fail(std::string("must be a number, is ") + kind_of(json));
    const double value = json.get<double>();
    if (!std::isfinite(value)) fail("must be finite");
    return value;
}

double JsonNode::as_number_in(double low, double high) const {
    const double value = as_number();
    if (value < low || value > high)
        fail("must be from " + number_text(low) + " to " + number_text(high) + ", is " +
             number_text(value));
    return value;
}

std::int64_t JsonNode::as_integer_in(std::int64_t low, std::int64_t high) const {
    const double value = as_number();
    if (value != std::floor(value)) fail("must be a whole number, is " + number_text(value));
    if (value < static_cast<double>(low) || value > static_cast<double>(high))
        fail("must be from " + std::to_string(low) + " to " + std::to_string(high) + ", is " +
             number_text(value));
    return static_cast<std::int64_t>(value);
}

bool JsonNode::as_bool() const {
    const Json& json = document_->at(pointer_);
    if (!json.is_boolean()) fail(std::string("must be true or false, is ") + kind_of(json));
    return json.get<bool>();
}

std::string JsonNode::as_string() const {
    const Json& json = document_->at(pointer_);
    if (!json.is_string()) fail(std::string("must be a string, is ") + kind_of(json));
    return json.get<std::string>();
}

std::size_t JsonNode::as_choice(const std::vector<std::string>& choices) const {
    const std::string value = as_string();
    const auto at = std::ranges::find(choices, value);
    if (at == choices.end()) fail("unknown \"" + value + "\" (known: " + joined(choices) + ")");
    return static_cast<std::size_t>(at - choices.begin());
}

std::vector<double> JsonNode::as_numbers(std::size_t count) const {
    const Json& json = document_->at(pointer_);
    if (!json.is_array() || json.size() != count)
        fail("must be a list of " + std::to_string(count) + " numbers");
    std::vector<double> values;
    for (const JsonNode& child : as_array()) values.push_back(child.as_number());
    return values;
}

std::vector<JsonNode> JsonNode::as_array() const {
    const Json& json = document_->at(pointer_);
    if (!json.is_array()) fail(std::string("must be a list, is ") + kind_of(json));
    std::vector<JsonNode> children;
    for (std::size_t i = 0; i < json.size(); ++i)
        children.push_back(JsonNode(document_, pointer_ + "/" + std::to_string(i)));
    return children;
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
    const Json& json = document_->at(pointer_);
    if (!json.is_object()) fail(std::string("must be an object, is ") + kind_of(json));
    document_->known[pointer_].insert(key);
    if (!json.contains(key)) return {};
    return JsonNode(document_, pointer_ + "/" + escaped(key));
}

JsonNode JsonNode::at(const std::string& key) const {
    const std::optional<JsonNode> child = find(key);
    if (!child) fail("needs the key \"" + key + "\"");
    return *child;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::others() const {
    const Json& json = document_->at(pointer_);
    if (!json.is_object()) fail(std::string("must be an object, is ") + kind_of(json));
    std::vector<std::pair<std::string, JsonNode>> children;
    std::set<std::string>& known = document_->known[pointer_];
    for (const std::string& key : keys_of(json))
        if (known.insert(key).second)
            children.emplace_back(key, JsonNode(document_, pointer_ + "/" + escaped(key)));
    return children;
}

void JsonNode::finish() const {
    const std::set<std::string>& known = document_->known[pointer_];
    for (const std::string& key : keys_of(document_->at(pointer_)))
        if (!known.contains(key))
            fail("unknown key \"" + key + "\" (known: " +
                 joined({known.begin(), known.end()}) + ")");
}

void JsonNode::fail(const std::string& reason) const { throw InputError(place() + ": " + reason); }

std::string JsonNode::place() const {
    return file().string() + ": " + (pointer_.empty() ? "/" : pointer_);
}

fs::path JsonNode::file() const {
    // The longest noted pointer that this one starts with.
    std::string prefix = pointer_;
    for (;;) {
        const auto at = document_->files.find(prefix);
        if (at != document_->files.end()) return at->second;
        const std::size_t slash = prefix.rfind('/');
        prefix.resize(slash == std::string::npos ? 0 : slash);
    }
}

std::string JsonNode::canonical() const { return document_->at(pointer_).dump(); }

}  // namespace caustics

#include "core/scene_file/json_document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace caustics {
namespace {

using nlohmann::json;

constexpr std::size_t max_depth = 64;
// Ten files that name the next one ten times each would be 10^10.
constexpr std::size_t most_inclusions = 10'000;
constexpr std::size_t most_included_bytes = std::size_t{1} << 26;

/// The library's message without its "[json.exception…] " tag.
std::string untagged(const std::string& message) {
    const std::size_t end = message.find("] ");
    return end == std::string::npos ? message : message.substr(end + 2);
}

void append_child(std::string& pointer, std::string_view key) {
    pointer += '/';
    for (const char c : key) {
        if (c == '~')
            pointer += "~0";
        else if (c == '/')
            pointer += "~1";
        else
            pointer += c;
    }
}

/// Makes a document of a text. Knows the pointer of each value, and refuses what the grammar does not allow, a key's
/// second time and control characters: a file's name would end at a NUL, and no name is printed with them. A callback
/// of json::parse() could do the same, but with one the library looks through all of an object's children at the end
/// of each child that is an object.
class DocumentBuilder final : public nlohmann::json_sax<json> {
public:
    explicit DocumentBuilder(const std::string& origin) : origin_(origin) {}

    json take() { return std::move(root_); }

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(number_integer_t value) override { return put(value); }
    bool number_unsigned(number_unsigned_t value) override { return put(value); }
    bool number_float(number_float_t value, const string_t&) override { return put(value); }
    bool binary(binary_t& value) override { return put(json::binary(std::move(value))); }
    bool string(string_t& value) override {
        put(std::move(value));
        require_printable(last_->get_ref<const std::string&>());
        return true;
    }
    bool start_object(std::size_t) override { return begin_level(json::object()); }
    bool start_array(std::size_t) override { return begin_level(json::array()); }
    bool end_object() override { return end_level(); }
    bool end_array() override { return end_level(); }
    bool key(string_t& name) override {
        Level& level = levels_.back();
        const auto [member, is_new] =
            level.value->get_ref<json::object_t&>().try_emplace(std::move(name));
        level.key = &member->first;
        level.member = &member->second;
        require_printable(*level.key);
        if (!is_new)
            throw InputError(origin_ + ": " + pointer() + ": key " + shown(*level.key) +
                             " is given twice in one object");
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const json::exception& error) override {
        throw InputError(origin_ + ": " + untagged(error.what()));
    }

private:
    /// An object or array that has begun; an object's member that is read.
    struct Level {
        json* value;
        const std::string* key = nullptr;
        json* member = nullptr;
    };

    bool put(json value) {
        last_ = &root_;
        if (!levels_.empty()) {
            const Level& level = levels_.back();
            if (level.value->is_array())
                last_ = &level.value->get_ref<json::array_t&>().emplace_back();
            else
                last_ = level.member;
        }
        *last_ = std::move(value);
        return true;
    }

    bool begin_level(json value) {
        put(std::move(value));
        if (levels_.size() >= max_depth)
            throw InputError(origin_ + ": " + pointer() + ": nested more than " +
                             std::to_string(max_depth) + " levels deep");
        levels_.push_back({last_});
        return true;
    }

    bool end_level() {
        levels_.pop_back();
        return true;
    }

    void require_printable(const std::string& text) const {
        const auto is_control = [](char c) {
            return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
        };
        if (std::ranges::any_of(text, is_control))
            throw InputError(origin_ + ": " + pointer() + ": a control character in " +
                             shown(text));
    }

    std::string pointer() const {
        std::string path;
        for (const Level& level : levels_)
            append_child(path, level.value->is_array() ? std::to_string(level.value->size() - 1)
                                                       : *level.key);
        return path.empty() ? "/" : path;
    }

    std::string origin_;
    json root_;
    json* last_ = &root_;  ///< the value that was read last
    std::vector<Level> levels_;
};

void append_numeral(std::string& text, double value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end.ptr);
}

void append_quoted(std::string& text, const std::string& word) {
    const auto is_plain = [](char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; };
    if (std::ranges::all_of(word, is_plain))
        text.append(1, '"').append(word).append(1, '"');
    else
        text += json(word).dump();
}

void append_canonical(std::string& text, const json& value) {
    char before = '[';
    switch (value.type()) {
        case json::value_t::object:
            before = '{';
            for (const auto& [key, child] : value.get_ref<const json::object_t&>()) {
                text += before;
                append_quoted(text, key);
                text += ':';
                append_canonical(text, child);
                before = ',';
            }
            text += before == '{' ? "{}" : "}";
            return;
        case json::value_t::array:
            for (const json& child : value) {
                text += before;
                append_canonical(text, child);
                before = ',';
            }
            text += before == '[' ? "[]" : "]";
            return;
        case json::value_t::string:
            append_quoted(text, value.get_ref<const std::string&>());
            return;
        case json::value_t::number_float: {
            const double number = value.get<double>();
            constexpr double exact_integers = 9007199254740992.0;
            if (std::abs(number) <= exact_integers && std::trunc(number) == number)
                text += std::to_string(static_cast<std::int64_t>(number));
            else
                append_numeral(text, number);
            return;
        }
        default: text += value.dump();
    }
}

class IncludeResolver {
public:
    /// A value stands at `pointer` of the document.
    IncludeResolver(JsonDocument& document, const std::string& pointer)
        : document_(document), pointer_(pointer), local_pointer_(pointer) {}

    void resolve(json& value, const std::filesystem::path& file) {
        if (value.is_object() && value.contains("$include")) {
            include(value, file);
        } else if (value.is_object()) {
            for (auto& [key, child] : value.get_ref<json::object_t&>())
                resolve_child(child, key, file);
        } else if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i)
                resolve_child(value[i], std::to_string(i), file);
        }
    }

    void enter(const std::filesystem::path& file) { open_.push_back(identity(file)); }

private:
    static std::filesystem::path identity(const std::filesystem::path& file) {
        std::error_code failed;
        std::filesystem::path path = std::filesystem::weakly_canonical(file, failed);
        return failed ? file : path;
    }

    void resolve_child(json& child, std::string_view key, const std::filesystem::path& file) {
        if (!child.is_structured()) return;
        const std::size_t length = pointer_.size();
        const std::size_t local_length = local_pointer_.size();
        append_child(pointer_, key);
        append_child(local_pointer_, key);
        resolve(child, file);
        pointer_.resize(length);
        local_pointer_.resize(local_length);
    }

    std::string take(const std::filesystem::path& file, const std::string& place) {
        std::string text = read_whole_file(file);
        bytes_ += text.size();
        if (++inclusions_ > most_inclusions || bytes_ > most_included_bytes)
            throw InputError(place + "more than " + std::to_string(most_inclusions) +
                             " inclusions, or more than 64 MiB of text in them");
        return text;
    }

    void include(json& value, const std::filesystem::path& file) {
        const std::string place =
            file.string() + ": " + child_pointer(local_pointer_, "$include") + ": ";
        if (value.size() != 1)
            throw InputError(place + "an object with \"$include\" may have no other key (has " +
                             key_list(value) + ")");
        const json name = value.at("$include");
        if (!name.is_string() || name.get_ref<const std::string&>().empty())
            throw InputError(place + "expected a file name, got " + shown(name));
        const std::filesystem::path target =
            (file.parent_path() / name.get<std::string>()).lexically_normal();
        if (std::find(open_.begin(), open_.end(), identity(target)) != open_.end())
            throw InputError(place + target.string() +
                             " includes itself, directly or through others");
        if (open_.size() >= max_depth)
            throw InputError(place + "files include each other more than " +
                             std::to_string(max_depth) + " levels deep");
        try {
            value = parse_json(take(target, place), target.string());
        } catch (const std::filesystem::filesystem_error& e) {
            throw InputError(place + e.what());
        } catch (const InputError& e) {
            throw InputError(std::string(e.what()) + " (included by " +
                             place.substr(0, place.size() - 2) + ")");
        }
        document_.included[pointer_] = target;
        document_.files_included.push_back(target);
        open_.push_back(identity(target));
        const std::string outer = std::exchange(local_pointer_, "");
        resolve(value, target);
        local_pointer_ = outer;
        open_.pop_back();
    }

    JsonDocument& document_;
    std::string pointer_;        ///< of the value that is resolved
    std::string local_pointer_;  ///< the same inside its file
    std::vector<std::filesystem::path> open_;
    std::size_t inclusions_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

JsonDocument::Keys& JsonDocument::asked_of(const json* object) {
    if (object != last_object || last_asked == nullptr) {
        last_asked = &keys[object];
        last_object = object;
    }
    return *last_asked;
}

bool JsonDocument::is_known(const json* object, const std::string& key) {
    const auto name = names.find(key);
    const std::vector<const std::string*>& known = asked_of(object).known;
    return name != names.end() && std::ranges::find(known, &*name) != known.end();
}

void JsonDocument::make_known(const json* object, const std::string& key) {
    std::vector<const std::string*>& known = asked_of(object).known;
    const std::string* const name = &*names.insert(key).first;
    if (std::ranges::find(known, name) == known.end()) known.push_back(name);
}

std::vector<std::string> JsonDocument::known_keys(const json* object) {
    std::vector<std::string> all;
    for (const std::string* const name : asked_of(object).known) all.push_back(*name);
    return all;
}

void JsonDocument::forget_keys(const json& value) {
    last_asked = nullptr;
    if (value.is_object()) keys.erase(&value);
    if (value.is_structured())
        for (const json& child : value) forget_keys(child);
}

std::map<std::string, std::filesystem::path>::const_iterator JsonDocument::inclusion(
    const std::string& pointer) const {
    for (std::string prefix = pointer;;) {
        const auto found = included.find(prefix);
        if (found != included.end() || prefix.empty()) return found;
        prefix.resize(prefix.rfind('/'));
    }
}

std::string JsonDocument::place(const std::string& pointer) const {
    const auto inclusion_point = inclusion(pointer);
    const auto visible = [](const std::string& p) { return p.empty() ? std::string("/") : p; };
    if (inclusion_point == included.end()) return one_line(file.string() + ": " + visible(pointer));
    std::string text = inclusion_point->second.string() + ": " +
                       visible(pointer.substr(inclusion_point->first.size()));
    if (!inclusion_point->first.empty())
        text += " (included as " + pointer + " of " + file.string() + ")";
    return one_line(text);
}

void JsonDocument::fail(const std::string& pointer, const std::string& reason) const {
    throw InputError(place(pointer) + ": " + reason);
}

std::string child_pointer(const std::string& pointer, const std::string& key) {
    std::string path;
    path.reserve(pointer.size() + 1 + key.size());
    path += pointer;
    append_child(path, key);
    return path;
}

std::string shown(const json& value) {
    if (value.is_number()) return canonical_json(value);
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    constexpr std::size_t readable = 60;
    if (text.size() <= readable) return text;
    std::size_t end = readable;
    while ((static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // inside a character
    return text.substr(0, end) + "...";
}

std::string join(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text.empty() ? "none" : text;
}

std::vector<std::string> keys_of(const json& value) {
    std::vector<std::string> keys;
    if (value.is_object())
        for (const auto& [key, child] : value.items()) keys.push_back(key);
    return keys;
}

std::string key_list(const json& object) { return join(keys_of(object)); }

json parse_json(const std::string& text, const std::string& origin) {
    // The library takes a NUL for the end of the text, whatever follows.
    if (const std::size_t nul = text.find('\0'); nul != std::string::npos)
        throw InputError(origin + ": byte " + std::to_string(nul + 1) +
                         " is NUL, which JSON has not (write it as UTF-8 text)");
    DocumentBuilder builder(origin);
    json::sax_parse(text, &builder);
    return builder.take();
}

void resolve_includes(json& value, const std::string& pointer, const std::filesystem::path& file,
                      JsonDocument& document) {
    IncludeResolver resolver(document, pointer);
    resolver.enter(file);
    resolver.resolve(value, file);
}

std::string canonical_json(const json& value) {
    std::string text;
    append_canonical(text, value);
    return text;
}

}  // namespace caustics

#include "core/scene_file/json_document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

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

/// Reads a text without keeping its values. Knows the pointer of each key, and refuses what the grammar does not
/// allow, a key's second time and control characters: a file's name would end at a NUL, and no name is printed with
/// them. A callback of json::parse() could do the same, but with one the library looks through all of an object's
/// children at the end of each child that is an object.
class DocumentGuard final : public nlohmann::json_sax<json> {
public:
    explicit DocumentGuard(const std::string& origin) : origin_(origin) {}

    bool null() override { return begin_value(); }
    bool boolean(bool) override { return begin_value(); }
    bool number_integer(number_integer_t) override { return begin_value(); }
    bool number_unsigned(number_unsigned_t) override { return begin_value(); }
    bool number_float(number_float_t, const string_t&) override { return begin_value(); }
    bool binary(binary_t&) override { return begin_value(); }
    bool string(string_t& value) override {
        begin_value();
        require_printable(value);
        return true;
    }
    bool start_object(std::size_t) override { return begin_level(false); }
    bool start_array(std::size_t) override { return begin_level(true); }
    bool end_object() override { return end_level(); }
    bool end_array() override { return end_level(); }
    bool key(string_t& name) override {
        require_printable(name);
        levels_.back().key = name;
        if (!levels_.back().keys.insert(name).second)
            throw InputError(origin_ + ": " + pointer() + ": key " + shown(name) +
                             " is given twice in one object");
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const json::exception& error) override {
        throw InputError(origin_ + ": " + untagged(error.what()));
    }

private:
    struct Level {
        bool array;
        std::size_t count;
        std::string key;
        std::unordered_set<std::string> keys;
    };

    bool begin_value() {
        if (!levels_.empty() && levels_.back().array)
            levels_.back().key = std::to_string(levels_.back().count++);
        return true;
    }

    bool begin_level(bool array) {
        begin_value();
        if (levels_.size() >= max_depth)
            throw InputError(origin_ + ": " + pointer() + ": nested more than " +
                             std::to_string(max_depth) + " levels deep");
        levels_.push_back({array, 0, {}, {}});
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
        for (const Level& level : levels_) path = child_pointer(path, level.key);
        return path.empty() ? "/" : path;
    }

    std::string origin_;
    std::vector<Level> levels_;
};

std::string numeral(double value) {
    std::string text(32, '\0');
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
    text.resize(static_cast<std::size_t>(end.ptr - text.data()));
    return text;
}

class IncludeResolver {
public:
    explicit IncludeResolver(JsonDocument& document) : document_(document) {}

    void resolve(json& value, const std::string& pointer, const std::string& local_pointer,
                 const std::filesystem::path& file) {
        if (value.is_object() && value.contains("$include")) {
            include(value, pointer, local_pointer, file);
        } else if (value.is_object()) {
            for (auto& [key, child] : value.items())
                resolve(child, child_pointer(pointer, key), child_pointer(local_pointer, key),
                        file);
        } else if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i)
                resolve(value[i], child_pointer(pointer, std::to_string(i)),
                        child_pointer(local_pointer, std::to_string(i)), file);
        }
    }

    void enter(const std::filesystem::path& file) { open_.push_back(identity(file)); }

private:
    static std::filesystem::path identity(const std::filesystem::path& file) {
        std::error_code failed;
        std::filesystem::path path = std::filesystem::weakly_canonical(file, failed);
        return failed ? file : path;
    }

    std::string take(const std::filesystem::path& file, const std::string& place) {
        std::string text = read_whole_file(file);
        bytes_ += text.size();
        if (++inclusions_ > most_inclusions || bytes_ > most_included_bytes)
            throw InputError(place + "more than " + std::to_string(most_inclusions) +
                             " inclusions, or more than 64 MiB of text in them");
        return text;
    }

    void include(json& value, const std::string& pointer, const std::string& local_pointer,
                 const std::filesystem::path& file) {
        const std::string place =
            file.string() + ": " + child_pointer(local_pointer, "$include") + ": ";
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
        document_.included[pointer] = target;
        document_.files_included.push_back(target);
        open_.push_back(identity(target));
        resolve(value, pointer, "", target);
        open_.pop_back();
    }

    JsonDocument& document_;
    std::vector<std::filesystem::path> open_;
    std::size_t inclusions_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

bool JsonDocument::is_known(const json* object, const std::string& key) {
    const auto name = names.find(key);
    const std::vector<const std::string*>& known = keys[object].known;
    return name != names.end() && std::ranges::find(known, &*name) != known.end();
}

void JsonDocument::make_known(const json* object, const std::string& key) {
    if (!is_known(object, key)) keys[object].known.push_back(&*names.insert(key).first);
}

std::vector<std::string> JsonDocument::known_keys(const json* object) {
    std::vector<std::string> all;
    for (const std::string* const name : keys[object].known) all.push_back(*name);
    return all;
}

void JsonDocument::forget_keys(const json& value) {
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
    std::string path = pointer + "/";
    for (const char c : key) {
        if (c == '~')
            path += "~0";
        else if (c == '/')
            path += "~1";
        else
            path += c;
    }
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
    DocumentGuard guard(origin);
    json::sax_parse(text, &guard);
    return json::parse(text);
}

void resolve_includes(json& value, const std::string& pointer, const std::filesystem::path& file,
                      JsonDocument& document) {
    IncludeResolver resolver(document);
    resolver.enter(file);
    resolver.resolve(value, pointer, pointer, file);
}

std::string canonical_json(const json& value) {
    std::string text;
    switch (value.type()) {
        case json::value_t::object:
            for (const auto& [key, child] : value.items()) {
                text += text.empty() ? "{" : ",";
                text += json(key).dump();
                text += ':';
                text += canonical_json(child);
            }
            return text.empty() ? "{}" : text + "}";
        case json::value_t::array:
            for (const json& child : value) {
                text += text.empty() ? "[" : ",";
                text += canonical_json(child);
            }
            return text.empty() ? "[]" : text + "]";
        case json::value_t::number_float: {
            const double number = value.get<double>();
            constexpr double exact_integers = 9007199254740992.0;
            if (std::abs(number) <= exact_integers && std::trunc(number) == number)
                return std::to_string(static_cast<std::int64_t>(number));
            return numeral(number);
        }
        default: return value.dump();
    }
}

}  // namespace caustics

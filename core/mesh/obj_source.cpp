#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/mesh_source.h"

namespace caustics {
namespace {

constexpr std::array<std::string_view, 16> ignored_keywords = {
    "o", "g", "s",   "mg",    "usemtl",   "mtllib",   "usemap",     "maplib",
    "l", "p", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};

constexpr auto max_float = static_cast<double>(std::numeric_limits<float>::max());

template <class Number>
std::optional<Number> parse(std::string_view text) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end) return {};
    return value;
}

class ObjChecker {
public:
    explicit ObjChecker(const std::string& name) : name_(name) {}

    void take_line(const std::string& line, std::size_t number) {
        line_ = number;
        words_.clear();
        std::istringstream stream(line.substr(0, line.find('#')));
        for (std::string word; stream >> word;) words_.push_back(word);
        if (words_.empty()) return;
        const std::string& keyword = words_[0];
        if (keyword == "v")
            take_position();
        else if (keyword == "vt")
            take_numbers(uvs_, words_.size() == 3 || words_.size() == 4, "2 or 3");
        else if (keyword == "vn")
            take_numbers(normals_, words_.size() == 4, "3");
        else if (keyword == "f")
            take_face();
        else if (std::find(ignored_keywords.begin(), ignored_keywords.end(), keyword) ==
                 ignored_keywords.end())
            fail(quoted(keyword) + " is not supported (v, vt, vn, f are read; names, groups, " +
                 "materials, points and lines are skipped)");
    }

    MeshSource finish() {
        if (source_.triangles == 0) throw InputError(name_ + ": no faces");
        return std::move(source_);
    }

private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(name_ + ":" + std::to_string(line_) + ": " + reason);
    }

    void keep_line() {
        for (const std::string& word : words_) source_.text += word + ' ';
        source_.text.back() = '\n';
    }

    double number(const std::string& word) const {
        const std::optional<double> value = parse<double>(word);
        if (!value) fail(quoted(word) + " is not a number");
        // Negated, so that NaN is caught too.
        if (!(std::abs(*value) <= max_float)) fail(quoted(word) + " is not a finite number");
        return *value;
    }

    void take_numbers(long& count, bool right_length, const std::string& lengths) {
        if (!right_length) fail(words_[0] + " needs " + lengths + " numbers");
        for (std::size_t i = 1; i < words_.size(); ++i) number(words_[i]);
        ++count;
        keep_line();
    }

    // x y z, or x y z w, or x y z r g b; colours are left out.
    void take_position() {
        const std::size_t numbers = words_.size() - 1;
        if (numbers == 4 && number(words_[4]) != 1)
            fail("positions with a weight w other than 1 are not supported");
        if (numbers == 6)
            for (std::size_t i = 4; i <= 6; ++i) number(words_[i]);
        const bool right_length = numbers == 3 || numbers == 4 || numbers == 6;
        if (right_length) words_.resize(4);
        take_numbers(positions_, right_length, "3, 4 or 6");
    }

    // An index counts from 1, or backwards from the last one (-1); all must stand before the face.
    void check_index(const std::string& word, std::string_view index, long count,
                     const std::string& what) const {
        const std::optional<long> value = parse<long>(index);
        if (!value) fail("face corner " + quoted(word) + " is not v, v/vt, v//vn or v/vt/vn");
        if (*value == 0 || *value > count || *value < -count)
            fail("face corner " + quoted(word) + ": no " + what + " " + std::string(index) +
                 " among the " + std::to_string(count) + " above");
    }

    // Checks one corner and returns which of position, uv, normal it has.
    int check_corner(const std::string& word) const {
        std::array<std::string_view, 3> parts;
        std::string_view rest = word;
        std::size_t count = 0;
        for (bool more = true; more; ++count) {
            const std::size_t slash = rest.find('/');
            if (count == 3) fail("face corner " + quoted(word) + " has more than three indices");
            parts[count] = rest.substr(0, slash);
            more = slash != std::string_view::npos;
            if (more) rest.remove_prefix(slash + 1);
        }
        check_index(word, parts[0], positions_, "position");
        // v//vn is the only form with an empty part.
        const bool has_uv = count == 2 || (count == 3 && !parts[1].empty());
        if (has_uv) check_index(word, parts[1], uvs_, "uv");
        if (count == 3) check_index(word, parts[2], normals_, "normal");
        return 1 + (has_uv ? 2 : 0) + (count == 3 ? 4 : 0);
    }

    void take_face() {
        const std::size_t corners = words_.size() - 1;
        if (corners < 3)
            fail("a face needs at least 3 corners, this one has " + std::to_string(corners));
        const int form = check_corner(words_[1]);
        for (std::size_t i = 2; i <= corners; ++i)
            if (check_corner(words_[i]) != form)
                fail("the corners of one face must all have the same form");
        source_.triangles += corners - 2;
        keep_line();
    }

    std::string name_;
    std::size_t line_ = 0;
    std::vector<std::string> words_;
    long positions_ = 0;
    long uvs_ = 0;
    long normals_ = 0;
    MeshSource source_;
};

}  // namespace

std::string quoted(const std::string& word) {
    std::string text = word.substr(0, 40);
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return "'" + text + "'";
}

MeshSource check_obj(const std::string& bytes, const std::string& name) {
    ObjChecker checker(name);
    std::istringstream stream(bytes);
    std::string logical;
    std::size_t number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        // A backslash at the end continues the line.
        const bool continued = !line.empty() && line.back() == '\\';
        if (continued) line.back() = ' ';
        logical += line;
        if (continued && stream.peek() != std::istringstream::traits_type::eof()) continue;
        checker.take_line(logical, number);
        logical.clear();
    }
    return checker.finish();
}

}  // namespace caustics

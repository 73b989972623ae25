#include "core/mesh/obj_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/math/polygon.h"
#include "core/mesh/exact_positions.h"
#include "core/mesh/quoted_word.h"
#include "core/mesh/vertex_table.h"

namespace caustics {
namespace {

constexpr std::array<std::string_view, 16> ignored_keywords = {
    "o", "g", "s",   "mg",    "usemtl",   "mtllib",   "usemap",     "maplib",
    "l", "p", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};

constexpr std::size_t lines_between_looks = 1 << 14;          // for Ctrl-C
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // of UTF-8
constexpr std::string_view white_space = " \t\r\v\f";

template <class Number>
std::optional<Number> parse(std::string_view text) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end) return {};
    return value;
}

class ObjReader {
public:
    explicit ObjReader(const std::string& name) : name_(name) {}

    void take_line(std::string_view line, std::size_t number) {
        line_ = number;
        if (number % lines_between_looks == 0) throw_if_interrupted();
        split(line);
        if (words_.empty()) return;
        const std::string_view keyword = words_[0];
        if (keyword == "v")
            take_position();
        else if (keyword == "vt")
            take_uv();
        else if (keyword == "vn")
            take_normal();
        else if (keyword == "f")
            take_face();
        else if (std::ranges::find(ignored_keywords, keyword) == ignored_keywords.end())
            fail(quoted_word(keyword) +
                 " is not supported (v, vt, vn, f are read; names, groups, " +
                 "materials, points and lines are skipped)");
    }

    TriangleMesh finish() {
        if (mesh_.triangles.empty()) throw InputError(name_ + ": no faces");
        std::vector<Vec3d> positions;
        for (const VertexTable::Vertex& v : table_.vertices()) {
            positions.emplace_back(v[0], v[1], v[2]);
            if (has_normals_) mesh_.normals.emplace_back(Vec3d(v[3], v[4], v[5]).cast<float>());
            if (has_uvs_) mesh_.uvs.emplace_back(Vec2d(v[6], v[7]).cast<float>());
        }
        set_positions(mesh_, std::move(positions));
        return std::move(mesh_);
    }

private:
    /// A corner of a face, by places in the lists above.
    struct Corner {
        std::size_t position = 0;
        std::optional<std::size_t> uv = {};
        std::optional<std::size_t> normal = {};

        int form() const { return (uv ? 2 : 0) + (normal ? 4 : 0); }
    };

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(name_ + ":" + std::to_string(line_) + ": " + reason);
    }

    void split(std::string_view line) {
        words_.clear();
        while (true) {
            line.remove_prefix(std::min(line.find_first_not_of(white_space), line.size()));
            if (line.empty()) return;
            words_.push_back(line.substr(0, line.find_first_of(white_space)));
            line.remove_prefix(words_.back().size());
        }
    }

    double number(std::string_view word) const {
        const std::optional<double> value = parse<double>(word);
        if (!value) fail(quoted_word(word) + " is not a number");
        // Negated, so that NaN is caught too.
        if (!(std::abs(*value) <= static_cast<double>(std::numeric_limits<float>::max())))
            fail(quoted_word(word) + " is not a finite number");
        return *value;
    }

    // The numbers of the line, the first three of which are wanted.
    std::array<double, 3> numbers(bool right_length, const char* lengths) const {
        if (!right_length) fail(std::string(words_[0]) + " needs " + lengths + " numbers");
        std::array<double, 3> found{};
        for (std::size_t i = 1; i < words_.size(); ++i) {
            const double value = number(words_[i]);
            if (i <= found.size()) found[i - 1] = value;
        }
        return found;
    }

    // x y z, or x y z w, or x y z r g b; colours are left out.
    void take_position() {
        const std::size_t count = words_.size() - 1;
        if (count == 4 && number(words_[4]) != 1)
            fail("positions with a weight w other than 1 are not supported");
        const auto [x, y, z] = numbers(count == 3 || count == 4 || count == 6, "3, 4 or 6");
        positions_.emplace_back(x, y, z);
    }

    // Turned as Mitsuba's `flip_tex_coords` has it.
    void take_uv() {
        const auto [u, v, w] = numbers(words_.size() == 3 || words_.size() == 4, "2 or 3");
        uvs_.emplace_back(static_cast<float>(u), 1 - static_cast<float>(v));
    }

    void take_normal() {
        const auto [x, y, z] = numbers(words_.size() == 4, "3");
        normals_.emplace_back(Vec3d(x, y, z).cast<float>());
    }

    // An index counts from 1, or backwards from the last one (-1); all must stand before the face.
    std::size_t place(std::string_view word, std::string_view index, std::size_t count,
                      const char* what) const {
        const std::optional<long> value = parse<long>(index);
        if (!value) fail("face corner " + quoted_word(word) + " is not v, v/vt, v//vn or v/vt/vn");
        const auto all = static_cast<long>(count);
        if (*value == 0 || *value > all || *value < -all)
            fail("face corner " + quoted_word(word) + ": no " + what + " " + std::string(index) +
                 " among the " + std::to_string(count) + " above");
        return static_cast<std::size_t>(*value > 0 ? *value - 1 : all + *value);
    }

    Corner corner(std::string_view word) const {
        std::array<std::string_view, 3> parts;
        std::string_view rest = word;
        std::size_t count = 0;
        for (bool more = true; more; ++count) {
            const std::size_t slash = rest.find('/');
            if (count == 3)
                fail("face corner " + quoted_word(word) + " has more than three indices");
            parts[count] = rest.substr(0, slash);
            more = slash != std::string_view::npos;
            if (more) rest.remove_prefix(slash + 1);
        }
        Corner found{place(word, parts[0], positions_.size(), "position")};
        // What is empty is not there: v//vn, and v/, v// or v/vt/ of writers that leave the slashes.
        if (!parts[1].empty()) found.uv = place(word, parts[1], uvs_.size(), "uv");
        if (!parts[2].empty()) found.normal = place(word, parts[2], normals_.size(), "normal");
        return found;
    }

    void take_face() {
        const std::size_t count = words_.size() - 1;
        if (count < 3)
            fail("a face needs at least 3 corners, this one has " + std::to_string(count));
        corners_.clear();
        polygon_.clear();
        for (std::size_t i = 1; i <= count; ++i) {
            corners_.push_back(corner(words_[i]));
            if (corners_.back().form() != corners_[0].form())
                fail("the corners of one face must all have the same form");
            polygon_.push_back(positions_[corners_.back().position]);
        }
        has_uvs_ = has_uvs_ || corners_[0].uv;
        has_normals_ = has_normals_ || corners_[0].normal;
        for (const auto& [a, b, c] : cut_face()) {
            const std::uint32_t first = vertex(corners_[a]);
            const std::uint32_t second = vertex(corners_[b]);
            mesh_.triangles.push_back({first, second, vertex(corners_[c])});
        }
    }

    std::vector<std::array<std::uint32_t, 3>> cut_face() const {
        try {
            return triangulate_polygon(polygon_);
        } catch (const InputError& error) {
            fail(error.what());
        }
    }

    std::uint32_t vertex(const Corner& corner) {
        const Vec3d& p = positions_[corner.position];
        const Vec3d n =
            corner.normal ? Vec3d(normals_[*corner.normal].cast<double>()) : Vec3d(0, 0, 0);
        const Vec2d t = corner.uv ? Vec2d(uvs_[*corner.uv].cast<double>()) : Vec2d(0, 1);
        return table_.index_of({p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), t.x(), t.y()});
    }

    std::string name_;
    std::size_t line_ = 0;
    std::vector<std::string_view> words_;
    std::vector<Corner> corners_;  // of the face at work
    std::vector<Vec3d> polygon_;
    std::vector<Vec3d> positions_;
    std::vector<Vec2> uvs_;
    std::vector<Vec3> normals_;
    bool has_uvs_ = false;
    bool has_normals_ = false;
    VertexTable table_;
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_obj(const std::string& bytes, const std::string& name) {
    ObjReader reader(name);
    std::string joined;  // lines that a backslash at their end continues
    std::size_t number = 0;
    std::string_view rest = bytes;
    if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
    while (!rest.empty()) {
        std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        ++number;
        // A comment ends with its line: a backslash in it, of a path for one, continues nothing.
        line = line.substr(0, line.find('#'));
        if (line.ends_with('\r')) line.remove_suffix(1);
        const bool continued = line.ends_with('\\');
        if (continued) line.remove_suffix(1);
        if (continued || !joined.empty()) joined.append(line).append(1, ' ');
        if (continued && !rest.empty()) continue;
        reader.take_line(joined.empty() ? line : joined, number);
        joined.clear();
    }
    return reader.finish();
}

}  // namespace caustics

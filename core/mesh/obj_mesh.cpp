#include "core/mesh/obj_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "core/base/decimal.h"
#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/math/polygon.h"
#include "core/mesh/exact_positions.h"
#include "core/mesh/quoted_word.h"
#include "core/mesh/vertex_table.h"

namespace caustics {
namespace {

// Names, groups, materials, points, lines, curves, and attributes of surfaces: none has an area.
constexpr std::string_view ignored_keywords[] = {
    "o",      "g",   "s",     "mg",       "usemtl",   "mtllib",     "usemap",    "maplib", "l",
    "p",      "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "vp",     "vw",
    "cstype", "deg", "bmat",  "step",     "curv",     "curv2",      "parm",      "trim",   "hole",
    "scrv",   "sp",  "end",   "con",      "ctech",    "stech",      "cdc",       "cdp",    "res"};
// Curved surfaces, whose light would be missing.
constexpr std::string_view surface_keywords[] = {"surf", "bsp", "bzp"};

constexpr std::size_t lines_between_looks = 1 << 14;          // for Ctrl-C
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // of UTF-8
constexpr std::string_view white_space = " \t\r\v\f";

std::optional<std::int64_t> parse_index(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
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
        else if (std::ranges::find(surface_keywords, keyword) != std::end(surface_keywords))
            fail(quoted_word(keyword) +
                 ": curved surfaces are not supported (export triangles or polygons)");
        else if (std::ranges::find(ignored_keywords, keyword) == std::end(ignored_keywords))
            fail(quoted_word(keyword) +
                 " is not supported (v, vt, vn, f are read; names, groups, " +
                 "materials, points, lines and curves are skipped)");
        else if (keyword == "cstype")
            has_curves_ = true;
    }

    TriangleMesh finish() {
        if (faces_.empty())
            throw InputError(name_ + (has_curves_ ? ": no faces: curves are not supported (export "
                                                    "triangles or polygons)"
                                                  : ": no faces"));
        const Corner* corners = corners_.data();
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            if (i % lines_between_looks == 0) throw_if_interrupted();
            line_ = faces_[i].line;
            cut_face({corners, faces_[i].size});
            corners += faces_[i].size;
        }
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
    /// A corner of a face: numbers in the file's lists, from 1; 0 where there is none.
    struct Corner {
        std::uint32_t position = 0;
        std::uint32_t uv = 0;
        std::uint32_t normal = 0;

        int form() const { return (uv > 0 ? 2 : 0) + (normal > 0 ? 4 : 0); }
        std::string text() const {
            std::string words = std::to_string(position);
            if (form() > 0) words += "/" + (uv > 0 ? std::to_string(uv) : "");
            return words + (normal > 0 ? "/" + std::to_string(normal) : "");
        }
    };
    struct Face {
        std::size_t line;
        std::size_t size;  ///< its corners
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
        const std::optional<double> value = foreign_number(word);
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

    // x y z, or homogeneous x y z w, or x y z r g b; colours are left out.
    void take_position() {
        const std::size_t count = words_.size() - 1;
        const auto [x, y, z] = numbers(count == 3 || count == 4 || count == 6, "3, 4 or 6");
        const double w = count == 4 ? number(words_[4]) : 1;
        const Vec3d position = Vec3d(x, y, z) / w;
        constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
        if (w == 0 || position.cwiseAbs().maxCoeff() > largest)
            fail("the weight w is " + std::string(words_[4]) +
                 ": the position, divided by it, is not finite");
        positions_.push_back(position);
    }

    // Turned as Mitsuba's `flip_tex_coords` has it.
    void take_uv() {
        const auto [u, v, w] = numbers(words_.size() >= 2 && words_.size() <= 4, "1 to 3");
        uvs_.emplace_back(static_cast<float>(u), 1 - static_cast<float>(v));
    }

    void take_normal() {
        const auto [x, y, z] = numbers(words_.size() == 4, "3");
        normals_.emplace_back(Vec3d(x, y, z).cast<float>());
    }

    // An index counts from 1, or backwards from the last one above (-1). Faces may come before what they name.
    std::uint32_t place(std::string_view word, std::string_view index, std::size_t count_above,
                        const char* what) const {
        const std::optional<std::int64_t> value = parse_index(index);
        if (!value) fail("face corner " + quoted_word(word) + " is not v, v/vt, v//vn or v/vt/vn");
        const std::int64_t from_one =
            *value < 0 ? static_cast<std::int64_t>(count_above) + 1 + *value : *value;
        if (*value == 0)
            fail("face corner " + quoted_word(word) + ": no " + what + " 0, the first one is 1");
        if (from_one < 1 || from_one > std::numeric_limits<std::uint32_t>::max())
            fail("face corner " + quoted_word(word) + ": no " + what + " " + std::string(index) +
                 (*value < 0 ? " among the " + std::to_string(count_above) + " above" : ""));
        return static_cast<std::uint32_t>(from_one);
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
        const std::size_t first = corners_.size();
        for (std::size_t i = 1; i <= count; ++i) {
            corners_.push_back(corner(words_[i]));
            if (corners_.back().form() != corners_[first].form())
                fail("the corners of one face must all have the same form");
        }
        faces_.push_back({line_, count});
    }

    void require_there(const Corner& corner) const {
        const auto require = [&](std::uint32_t number, std::size_t count, const char* what) {
            if (number > count)
                fail("face corner '" + corner.text() + "': no " + what + " " +
                     std::to_string(number) + " among the " + std::to_string(count) +
                     " of the file");
        };
        require(corner.position, positions_.size(), "position");
        require(corner.uv, uvs_.size(), "uv");
        require(corner.normal, normals_.size(), "normal");
    }

    void cut_face(std::span<const Corner> corners) {
        polygon_.clear();
        for (const Corner& corner : corners) {
            require_there(corner);
            polygon_.push_back(positions_[corner.position - 1]);
        }
        has_uvs_ = has_uvs_ || corners[0].uv > 0;
        has_normals_ = has_normals_ || corners[0].normal > 0;
        for (const auto& [a, b, c] : cut_polygon()) {
            const std::uint32_t first = vertex(corners[a]);
            const std::uint32_t second = vertex(corners[b]);
            mesh_.triangles.push_back({first, second, vertex(corners[c])});
        }
    }

    std::vector<std::array<std::uint32_t, 3>> cut_polygon() const {
        try {
            return triangulate_polygon(polygon_);
        } catch (const InputError& error) {
            fail(error.what());
        }
    }

    std::uint32_t vertex(const Corner& corner) {
        const Vec3d& p = positions_[corner.position - 1];
        const Vec3d n =
            corner.normal > 0 ? Vec3d(normals_[corner.normal - 1].cast<double>()) : Vec3d(0, 0, 0);
        const Vec2d t = corner.uv > 0 ? Vec2d(uvs_[corner.uv - 1].cast<double>()) : Vec2d(0, 1);
        return table_.index_of({p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), t.x(), t.y()});
    }

    std::string name_;
    std::size_t line_ = 0;
    std::vector<std::string_view> words_;
    std::vector<Face> faces_;
    std::vector<Corner> corners_;  // of all faces, one after the other
    std::vector<Vec3d> polygon_;   // of the face at work
    std::vector<Vec3d> positions_;
    std::vector<Vec2> uvs_;
    std::vector<Vec3> normals_;
    bool has_uvs_ = false;
    bool has_normals_ = false;
    bool has_curves_ = false;
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

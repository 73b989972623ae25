#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "core/mesh/mesh_source.h"
#include "core/mesh/ply_file.h"

namespace caustics {
namespace {

constexpr auto max_float = static_cast<double>(std::numeric_limits<float>::max());

template <class Value>
void append(std::string& text, Value value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
    text.append(raw.data(), raw.size());
}

// Which properties of a vertex are kept, and under which name. A group is kept whole or not at all.
struct KeptGroup {
    std::vector<std::string> given;
    std::vector<std::string> kept;
};

const std::vector<KeptGroup>& kept_groups() {
    static const std::vector<KeptGroup> groups = {{{"x", "y", "z"}, {"x", "y", "z"}},
                                                  {{"nx", "ny", "nz"}, {"nx", "ny", "nz"}},
                                                  {{"u", "v"}, {"u", "v"}},
                                                  {{"s", "t"}, {"u", "v"}},
                                                  {{"texture_u", "texture_v"}, {"u", "v"}}};
    return groups;
}

/// Reads the elements and writes the plain file.
class PlyChecker {
public:
    PlyChecker(const std::string& bytes, const std::string& name) : file_(bytes, name) {}

    MeshSource run() {
        const std::vector<PlyElement> elements = file_.read_header();
        const PlyElement& vertices = the_element(elements, "vertex");
        const PlyElement& faces = the_element(elements, "face");
        vertex_count_ = vertices.count;
        choose_columns(vertices);
        std::string vertex_data;
        std::string face_data;
        for (const PlyElement& element : elements)
            for (std::size_t i = 0; i < element.count; ++i) {
                if (&element == &vertices)
                    read_vertex(element, i, vertex_data);
                else if (&element == &faces)
                    read_face(element, i, face_data);
                else
                    for (const PlyProperty& property : element.properties)
                        read_property(element, property, i);
            }
        file_.expect_end();
        if (triangles_ == 0) file_.fail("no faces");
        return {header(faces.count) + vertex_data + face_data, triangles_};
    }

private:
    const PlyElement& the_element(const std::vector<PlyElement>& elements,
                                  const std::string& name) {
        const PlyElement* found = nullptr;
        for (const PlyElement& element : elements) {
            // Also keeps a wrong count from being a long loop over nothing.
            if (element.properties.empty())
                file_.fail("element " + quoted(element.name) + " has no properties");
            if (element.name != name) continue;
            if (found != nullptr) file_.fail("more than one element '" + name + "'");
            found = &element;
        }
        if (found == nullptr) file_.fail("no element '" + name + "' (not a triangle mesh)");
        return *found;
    }

    void choose_columns(const PlyElement& vertices) {
        const auto column = [&](const std::string& name) -> std::optional<std::size_t> {
            for (std::size_t i = 0; i < vertices.properties.size(); ++i)
                if (vertices.properties[i].name == name && !vertices.properties[i].count_type)
                    return i;
            return {};
        };
        bool uv_chosen = false;
        for (const KeptGroup& group : kept_groups()) {
            const bool complete = std::all_of(group.given.begin(), group.given.end(),
                                              [&](const auto& name) { return column(name); });
            if (!complete && group.kept[0] == "x") file_.fail("vertices have no x, y, z");
            if (!complete || (uv_chosen && group.kept[0] == "u")) continue;
            uv_chosen = group.kept[0] == "u";
            for (std::size_t i = 0; i < group.given.size(); ++i) {
                columns_.push_back(*column(group.given[i]));
                names_.push_back(group.kept[i]);
            }
        }
    }

    // The values of a property: one, or a list's.
    const std::vector<double>& read_property(const PlyElement& element, const PlyProperty& property,
                                             std::size_t index) {
        std::size_t count = 1;
        if (property.count_type)
            count = to_index(element, index, file_.read(*property.count_type, element.name, index));
        values_.clear();
        for (std::size_t i = 0; i < count; ++i)
            values_.push_back(file_.read(property.type, element.name, index));
        return values_;
    }

    std::size_t to_index(const PlyElement& element, std::size_t index, double value) const {
        // Negated, so that NaN is caught too.
        if (!(value >= 0 && value <= std::numeric_limits<std::uint32_t>::max()) ||
            value != std::floor(value))
            fail(element, index, "count or index " + number_text(value) + " is not possible");
        return static_cast<std::size_t>(value);
    }

    static std::string number_text(double value) {
        std::ostringstream text;
        text << value;
        return text.str();
    }

    [[noreturn]] void fail(const PlyElement& element, std::size_t index,
                           const std::string& reason) const {
        file_.fail(element.name + " " + std::to_string(index) + ": " + reason);
    }

    void read_vertex(const PlyElement& element, std::size_t index, std::string& out) {
        row_.clear();
        for (const PlyProperty& property : element.properties) {
            const std::vector<double>& values = read_property(element, property, index);
            row_.push_back(property.count_type ? 0.0 : values[0]);
        }
        // `pad`, never 0x0A.
        out.push_back(0);
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const double value = row_[columns_[i]];
            if (!(std::abs(value) <= max_float))
                fail(element, index,
                     names_[i] + " is " + number_text(value) + ", not a finite number");
            append(out, static_cast<float>(value));
        }
    }

    void read_face(const PlyElement& element, std::size_t index, std::string& out) {
        bool found = false;
        for (const PlyProperty& property : element.properties) {
            const std::vector<double>& corners = read_property(element, property, index);
            const bool indices = property.count_type && (property.name == "vertex_indices" ||
                                                         property.name == "vertex_index");
            if (!indices || found) continue;
            found = true;
            if (corners.size() < 3)
                fail(element, index,
                     "a face needs at least 3 corners, this one has " +
                         std::to_string(corners.size()));
            append(out, static_cast<std::uint32_t>(corners.size()));
            for (const double corner : corners) {
                if (to_index(element, index, corner) >= vertex_count_)
                    fail(element, index,
                         "vertex " + number_text(corner) + " is not among the " +
                             std::to_string(vertex_count_) + " vertices");
                append(out, static_cast<std::uint32_t>(corner));
            }
            triangles_ += corners.size() - 2;
        }
        if (!found) file_.fail("faces have no list 'vertex_indices' or 'vertex_index'");
    }

    std::string header(std::size_t face_count) const {
        std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                           std::to_string(vertex_count_) + "\nproperty uchar pad\n";
        for (const std::string& name : names_) text += "property float " + name + '\n';
        return text + "element face " + std::to_string(face_count) +
               "\nproperty list uint uint vertex_indices\nend_header\n";
    }

    PlyFile file_;
    std::size_t vertex_count_ = 0;
    std::size_t triangles_ = 0;
    std::vector<std::size_t> columns_;  // of the kept properties
    std::vector<std::string> names_;    // of the kept properties
    std::vector<double> values_;
    std::vector<double> row_;
};

}  // namespace

MeshSource check_ply(const std::string& bytes, const std::string& name) {
    return PlyChecker(bytes, name).run();
}

}  // namespace caustics

#include "core/mesh/ply_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/math/polygon.h"
#include "core/mesh/exact_positions.h"
#include "core/mesh/ply_file.h"
#include "core/mesh/quoted_word.h"

namespace caustics {
namespace {

using namespace std::string_literals;

constexpr std::size_t values_between_looks = 1 << 14;  // for Ctrl-C

// Names that programs give to the list of a face's corners. The last counts only where neither of the others is there.
constexpr std::string_view names_of_corners[] = {"vertex_indices", "vertex_index"};
constexpr std::string_view spare_name_of_corners = "indices";
constexpr const char* corner_lists = "vertex_indices, vertex_index or indices";

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

class PlyReader {
public:
    PlyReader(const std::string& bytes, const std::string& name) : file_(bytes, name) {}

    TriangleMesh run() {
        const std::vector<PlyElement> elements = file_.read_header();
        const PlyElement& vertices = the_element(elements, "vertex");
        const PlyElement& faces = the_element(elements, "face");
        vertex_count_ = vertices.count;
        choose_columns(vertices);
        choose_corners(faces);
        for (const PlyElement& element : elements)
            for (std::size_t i = 0; i < element.count; ++i) {
                if (i % values_between_looks == 0) throw_if_interrupted();
                if (&element == &vertices)
                    read_vertex(element, i);
                else if (&element == &faces)
                    read_face(element, i);
                else
                    for (const PlyProperty& property : element.properties)
                        read_property(element, property, i);
            }
        file_.expect_end();
        if (file_.is_binary() && has_float_positions(vertices)) require_fine_floats();
        cut_polygons();
        if (mesh_.triangles.empty()) file_.fail("no faces");
        return std::move(mesh_);
    }

private:
    const PlyElement& the_element(const std::vector<PlyElement>& elements,
                                  const std::string& name) {
        const PlyElement* found = nullptr;
        for (const PlyElement& element : elements) {
            // Also keeps a wrong count from being a long loop over nothing.
            if (element.properties.empty())
                file_.fail("element " + quoted_word(element.name) + " has no properties");
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
        for (const KeptGroup& group : kept_groups()) {
            const auto there = std::ranges::count_if(
                group.given, [&](const auto& name) { return column(name).has_value(); });
            const bool complete = there == std::ssize(group.given);
            if (!complete && group.kept[0] == "x") file_.fail("vertices have no x, y, z");
            if (!complete && there > 0 && group.kept[0] == "nx")
                file_.fail("normals need all of nx, ny, nz");
            if (!complete || (has_uvs_ && group.kept[0] == "u")) continue;
            has_normals_ = has_normals_ || group.kept[0] == "nx";
            has_uvs_ = has_uvs_ || group.kept[0] == "u";
            for (std::size_t i = 0; i < group.given.size(); ++i) {
                columns_.push_back(*column(group.given[i]));
                names_.push_back(group.kept[i]);
            }
        }
    }

    void choose_corners(const PlyElement& faces) {
        for (std::size_t i = 0; i < faces.properties.size(); ++i) {
            const PlyProperty& property = faces.properties[i];
            if (!property.count_type ||
                std::ranges::find(names_of_corners, property.name) == std::end(names_of_corners))
                continue;
            if (corner_list_)
                file_.fail("faces have more than one list of corners ("s + corner_lists + ")");
            corner_list_ = i;
        }
        for (std::size_t i = 0; !corner_list_ && i < faces.properties.size(); ++i) {
            const PlyProperty& property = faces.properties[i];
            if (property.count_type && property.name == spare_name_of_corners) corner_list_ = i;
        }
        if (!corner_list_) file_.fail("faces have no list of corners ("s + corner_lists + ")");
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

    void read_vertex(const PlyElement& element, std::size_t index) {
        row_.clear();
        for (const PlyProperty& property : element.properties) {
            const std::vector<double>& values = read_property(element, property, index);
            row_.push_back(property.count_type ? 0.0 : values[0]);
        }
        kept_.clear();
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const double value = row_[columns_[i]];
            if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
                fail(element, index,
                     names_[i] + " is " + number_text(value) + ", not a finite number");
            kept_.push_back(value);
        }
        mesh_.exact_positions.emplace_back(kept_[0], kept_[1], kept_[2]);
        if (has_normals_)
            mesh_.normals.emplace_back(Vec3d(kept_[3], kept_[4], kept_[5]).cast<float>());
        if (has_uvs_)
            mesh_.uvs.emplace_back(Vec2d(kept_[kept_.size() - 2], kept_.back()).cast<float>());
    }

    void read_face(const PlyElement& element, std::size_t index) {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const std::vector<double>& values =
                read_property(element, element.properties[i], index);
            if (i == corner_list_) take_corners(element, index, values);
        }
    }

    void take_corners(const PlyElement& element, std::size_t index,
                      const std::vector<double>& corners) {
        if (corners.size() < 3)
            fail(element, index,
                 "a face needs at least 3 corners, this one has " + std::to_string(corners.size()));
        polygon_sizes_.push_back(static_cast<std::uint32_t>(corners.size()));
        for (const double corner : corners) {
            if (to_index(element, index, corner) >= vertex_count_)
                fail(element, index,
                     "vertex " + number_text(corner) + " is not among the " +
                         std::to_string(vertex_count_) + " vertices");
            corners_.push_back(static_cast<std::uint32_t>(corner));
        }
    }

    std::vector<std::array<std::uint32_t, 3>> cut_face(const std::vector<Vec3d>& polygon,
                                                       std::size_t face) const {
        try {
            return triangulate_polygon(polygon);
        } catch (const InputError& error) {
            file_.fail("face " + std::to_string(face) + ": " + error.what());
        }
    }

    bool has_float_positions(const PlyElement& vertices) const {
        return std::any_of(columns_.begin(), columns_.begin() + 3, [&](std::size_t column) {
            return vertices.properties[column].type == PlyType::float32;
        });
    }

    // Digits that the file itself has lost cannot be restored.
    void require_fine_floats() const {
        Eigen::AlignedBox3d box;
        for (const Vec3d& p : mesh_.exact_positions) box.extend(p);
        const double reach = box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff();
        const double step = reach * static_cast<double>(std::numeric_limits<float>::epsilon());
        const double width = box.diagonal().norm();
        constexpr double coarsest = 1e-3;
        if (!box.isEmpty() && step > coarsest * width)
            file_.fail(
                "positions are floats, " + number_text(step) + " m apart at " + number_text(reach) +
                " m from the origin, too coarse for a mesh " + number_text(width) +
                " m wide (a file near its origin, or with doubles, and to_world place it exactly)");
    }

    // Faces may come before their vertices.
    void cut_polygons() {
        std::vector<Vec3d> polygon;
        const std::uint32_t* corners = corners_.data();
        for (std::size_t face = 0; face < polygon_sizes_.size(); ++face) {
            const std::uint32_t size = polygon_sizes_[face];
            polygon.clear();
            for (std::uint32_t i = 0; i < size; ++i)
                polygon.push_back(mesh_.exact_positions[corners[i]]);
            for (const auto& [a, b, c] : cut_face(polygon, face))
                mesh_.triangles.push_back({corners[a], corners[b], corners[c]});
            corners += size;
        }
    }

    PlyFile file_;
    std::size_t vertex_count_ = 0;
    std::vector<std::size_t> columns_;        // of the kept properties: position, normal, uv
    std::vector<std::string> names_;          // of the kept properties
    std::optional<std::size_t> corner_list_;  // which property of a face
    bool has_normals_ = false;
    bool has_uvs_ = false;
    std::vector<double> values_;
    std::vector<double> row_;
    std::vector<double> kept_;
    std::vector<std::uint32_t> polygon_sizes_;
    std::vector<std::uint32_t> corners_;  // of all polygons, one after the other
    TriangleMesh mesh_;
};

// Vertices that no triangle has are no part of the surface, nor of its bounds.
void drop_unused_vertices(TriangleMesh& mesh) {
    constexpr std::uint32_t unused = ~0U;
    std::vector<std::uint32_t> place(mesh.exact_positions.size(), unused);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) place[corner] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < place.size(); ++i) {
        if (place[i] == unused) continue;
        mesh.exact_positions[count] = mesh.exact_positions[i];
        if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
        if (!mesh.uvs.empty()) mesh.uvs[count] = mesh.uvs[i];
        place[i] = count++;
    }
    mesh.exact_positions.resize(count);
    if (!mesh.normals.empty()) mesh.normals.resize(count);
    if (!mesh.uvs.empty()) mesh.uvs.resize(count);
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) corner = place[corner];
}

}  // namespace

TriangleMesh read_ply(const std::string& bytes, const std::string& name) {
    TriangleMesh mesh = PlyReader(bytes, name).run();
    drop_unused_vertices(mesh);
    set_positions(mesh, std::move(mesh.exact_positions));
    return mesh;
}

}  // namespace caustics

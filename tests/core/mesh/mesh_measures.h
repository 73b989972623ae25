#pragma once

#include <map>
#include <set>
#include <utility>

#include "core/mesh/mesh.h"
#include "core/mesh/vertex_normals.h"

namespace caustics::test {

inline Vec3d corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t i) {
    return mesh.positions[mesh.triangles[triangle][i]].cast<double>();
}

inline Vec3d area_vector(const TriangleMesh& mesh, std::size_t t) {
    const Vec3d a = corner(mesh, t, 0);
    return (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a) / 2;
}

inline double area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += area_vector(mesh, t).norm();
    return sum;
}

/// Divergence theorem: the flux of x / 3.
inline double volume(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        sum += corner(mesh, t, 0).dot(area_vector(mesh, t)) / 3;
    return sum;
}

/// How many triangles run along each edge in each direction; vertices at one position are one.
inline std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> places = number_positions(mesh.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> found;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            ++found[{places[triangle[i]], places[triangle[(i + 1) % 3]]}];
    return found;
}

/// Edges that do not have one triangle on each side, wound alike.
inline std::size_t open_edges(const TriangleMesh& mesh) {
    const auto all = edges(mesh);
    std::size_t open = 0;
    for (const auto& [edge, count] : all) {
        const auto back = all.find({edge.second, edge.first});
        if (count != 1 || back == all.end() || back->second != 1) ++open;
    }
    return open;
}

/// V - E + F; vertices at one position are one.
inline int euler_characteristic(const TriangleMesh& mesh) {
    std::set<std::uint32_t> vertices;
    std::set<std::pair<std::uint32_t, std::uint32_t>> undirected;
    for (const auto& [edge, count] : edges(mesh)) {
        vertices.insert(edge.first);
        undirected.insert(std::minmax(edge.first, edge.second));
    }
    return static_cast<int>(vertices.size()) - static_cast<int>(undirected.size()) +
           static_cast<int>(mesh.triangles.size());
}

}  // namespace caustics::test

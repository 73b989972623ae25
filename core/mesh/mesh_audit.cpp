#include "core/mesh/mesh_audit.h"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "core/base/interrupt.h"
#include "core/base/sort_by_number.h"
#include "core/mesh/vertex_normals.h"

namespace caustics {
namespace {

using Place = std::array<float, 3>;

constexpr std::size_t triangles_between_looks = 1 << 16;

std::vector<std::array<Place, 3>> sorted_triangles(const TriangleMesh& mesh) {
    std::vector<std::array<Place, 3>> all;
    for (const auto& triangle : mesh.triangles) {
        std::array<Place, 3> places{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& p = mesh.positions[triangle[i]];
            places[i] = {p.x(), p.y(), p.z()};
        }
        std::ranges::sort(places);
        all.push_back(places);
    }
    std::ranges::sort(all);
    return all;
}

}  // namespace

std::size_t open_edge_count(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> places = number_positions(mesh.positions);
    using Edge = std::pair<std::pair<std::uint32_t, std::uint32_t>, int>;  // its ends, its side
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t % triangles_between_looks == 0) throw_if_interrupted();
        const auto& triangle = mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = places[triangle[i]];
            const std::uint32_t b = places[triangle[(i + 1) % 3]];
            if (a != b) edges.push_back({std::minmax(a, b), a < b ? 1 : -1});
        }
    }
    edges = sort_by_number(
        std::span<const Edge>(edges), mesh.positions.size(), 1,
        [](const Edge& edge) { return edge.first.first; }, std::less<Edge>());
    std::size_t open = 0;
    for (std::size_t i = 0; i < edges.size();) {
        int balance = 0;
        std::size_t next = i;
        for (; next < edges.size() && edges[next].first == edges[i].first; ++next)
            balance += edges[next].second;
        open += balance != 0 ? 1 : 0;
        i = next;
    }
    return open;
}

double enclosed_volume(const TriangleMesh& mesh) {
    if (mesh.positions.empty()) return 0;
    // From a vertex of its own, so that a mesh far away loses no digits.
    const Vec3d origin = mesh.positions.front().cast<double>();
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3d p = mesh.positions[a].cast<double>() - origin;
        const Vec3d q = mesh.positions[b].cast<double>() - origin;
        const Vec3d r = mesh.positions[c].cast<double>() - origin;
        sum += p.dot(q.cross(r)) / 6;
    }
    return sum;
}

std::size_t common_triangles(const TriangleMesh& one, const TriangleMesh& other) {
    const auto first = sorted_triangles(one);
    const auto second = sorted_triangles(other);
    return static_cast<std::size_t>(std::ranges::count_if(
        first, [&](const auto& triangle) { return std::ranges::binary_search(second, triangle); }));
}

}  // namespace caustics

#include "core/mesh/mesh_audit.h"

#include <algorithm>
#include <array>
#include <vector>

namespace caustics {
namespace {

using Place = std::array<float, 3>;

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

std::size_t common_triangles(const TriangleMesh& one, const TriangleMesh& other) {
    const auto first = sorted_triangles(one);
    const auto second = sorted_triangles(other);
    return static_cast<std::size_t>(std::ranges::count_if(
        first, [&](const auto& triangle) { return std::ranges::binary_search(second, triangle); }));
}

}  // namespace caustics

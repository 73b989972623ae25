#include "core/mesh/mesh_audit.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace caustics {
namespace {

using Place = std::array<float, 3>;

struct PlacedTriangle {
    std::array<Place, 3> places;  ///< sorted
    std::size_t mesh;

    auto operator<=>(const PlacedTriangle&) const = default;
};

/// The triangles of all meshes. Those at one place stand side by side, in the order of their meshes.
std::vector<PlacedTriangle> sorted_triangles(std::span<const TriangleMesh* const> meshes) {
    std::vector<PlacedTriangle> all;
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh)
        for (const auto& triangle : meshes[mesh]->triangles) {
            PlacedTriangle placed{{}, mesh};
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3& p = meshes[mesh]->positions[triangle[i]];
                placed.places[i] = {p.x(), p.y(), p.z()};
            }
            std::ranges::sort(placed.places);
            all.push_back(placed);
        }
    std::ranges::sort(all);
    return all;
}

}  // namespace

std::vector<CommonTriangles> common_triangles(std::span<const TriangleMesh* const> meshes) {
    if (meshes.size() < 2) return {};
    const std::vector<PlacedTriangle> all = sorted_triangles(meshes);
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> counts;
    for (auto begin = all.begin(); begin != all.end();) {
        const auto end = std::find_if(begin, all.end(), [&](const PlacedTriangle& triangle) {
            return triangle.places != begin->places;
        });
        for (auto one = begin; one != end; ++one)
            for (auto other = one + 1; other != end; ++other)
                // A mesh that has the triangle twice is one mesh all the same.
                if (other->mesh != one->mesh && other->mesh != (other - 1)->mesh)
                    ++counts[{one->mesh, other->mesh}];
        begin = end;
    }
    std::vector<CommonTriangles> common;
    for (const auto& [pair, count] : counts) common.push_back({pair.first, pair.second, count});
    return common;
}

}  // namespace caustics

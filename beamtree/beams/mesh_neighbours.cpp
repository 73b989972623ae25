#include "beamtree/beams/mesh_neighbours.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "core/base/sort_by_number.h"

namespace caustics::beamtree {
namespace {

/// A triangle at one of its edges, whose ends are in ascending order.
struct EdgeOfTriangle {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t opposite;  ///< the third corner
    std::uint32_t triangle;
};

std::vector<EdgeOfTriangle> sorted_edges(const CasterMesh& caster) {
    std::vector<EdgeOfTriangle> edges;
    edges.reserve(3 * caster.mesh.triangles.size());
    for (std::uint32_t t = 0; t < caster.mesh.triangles.size(); ++t) {
        if (caster.left_out[t]) continue;
        const auto& corners = caster.mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
            edges.push_back({low, high, corners[(i + 2) % 3], t});
        }
    }
    return sort_by_number(
        std::span<const EdgeOfTriangle>(edges), caster.mesh.positions.size(), 1,
        [](const EdgeOfTriangle& edge) { return edge.low; },
        [](const EdgeOfTriangle& a, const EdgeOfTriangle& b) {
            return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
        });
}

/// Two triangles that share an edge.
struct Pair {
    float defect;  ///< how far from a parallelogram, for its size
    std::array<std::uint32_t, 2> triangles;
};

Pair pair_of(const std::vector<Vec3>& p, const EdgeOfTriangle& a, const EdgeOfTriangle& b) {
    const Vec3 gap = p[a.low] + p[a.high] - p[a.opposite] - p[b.opposite];
    const float size =
        (p[a.low] - p[a.high]).squaredNorm() + (p[a.opposite] - p[b.opposite]).squaredNorm();
    return {gap.squaredNorm() / size, {a.triangle, b.triangle}};
}

}  // namespace

MeshNeighbours::MeshNeighbours(const CasterMesh& caster, int threads)
    : partners_(caster.mesh.triangles.size(), none) {
    parallel_chunks(threads, 2, 1, [&](const Chunk& task) {
        if (task.index == 0) {
            find_rings(caster);
        } else {
            pair_cells(caster);
            pair_others(caster);
        }
    });
}

std::span<const std::uint32_t> MeshNeighbours::round(std::uint32_t vertex) const {
    return std::span(vertices_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
}

void MeshNeighbours::find_rings(const CasterMesh& caster) {
    using Way = std::array<std::uint32_t, 2>;  // from, to
    std::vector<Way> ways;
    ways.reserve(6 * caster.mesh.triangles.size());
    for (std::uint32_t t = 0; t < caster.mesh.triangles.size(); ++t) {
        if (caster.left_out[t]) continue;
        const auto& corners = caster.mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            ways.push_back({corners[i], corners[(i + 1) % 3]});
            ways.push_back({corners[(i + 1) % 3], corners[i]});
        }
    }
    ways = sort_by_number(
        std::span<const Way>(ways), caster.mesh.positions.size(), 1,
        [](const Way& way) { return way[0]; },
        [](const Way& a, const Way& b) { return a[1] < b[1]; });
    ways.erase(std::unique(ways.begin(), ways.end()), ways.end());
    first_.assign(caster.mesh.positions.size() + 1, 0);
    vertices_.reserve(ways.size());
    for (const auto& [from, to] : ways) {
        ++first_[from + 1];
        vertices_.push_back(to);
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

void MeshNeighbours::pair_cells(const CasterMesh& caster) {
    for (const GridPatch& patch : caster.mesh.patches) {
        if (patch.cell_triangles != 2) continue;
        for (std::uint32_t cell = 0; cell < patch.columns * patch.rows; ++cell) {
            const std::uint32_t t = patch.first_triangle + 2 * cell;
            if (caster.left_out[t] || caster.left_out[t + 1]) continue;
            partners_[t] = t + 1;
            partners_[t + 1] = t;
        }
    }
}

void MeshNeighbours::pair_others(const CasterMesh& caster) {
    std::vector<Pair> pairs;
    const std::vector<EdgeOfTriangle> edges = sorted_edges(caster);
    for (std::size_t i = 1; i < edges.size(); ++i) {
        const EdgeOfTriangle& a = edges[i - 1];
        const EdgeOfTriangle& b = edges[i];
        const bool one_edge = a.low == b.low && a.high == b.high;
        if (one_edge && partners_[a.triangle] == none && partners_[b.triangle] == none)
            pairs.push_back(pair_of(caster.mesh.positions, a, b));
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
        return std::tie(a.defect, a.triangles) < std::tie(b.defect, b.triangles);
    });
    for (const Pair& pair : pairs) {
        const auto [a, b] = pair.triangles;
        if (partners_[a] != none || partners_[b] != none) continue;
        partners_[a] = b;
        partners_[b] = a;
    }
}

}  // namespace caustics::beamtree

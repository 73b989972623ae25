#include "beamtree/beams/closed_parts.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <tuple>

#include "beamtree/beams/pieces.h"
#include "beamtree/beams/solid_angle.h"
#include "core/base/interrupt.h"
#include "core/base/sort_by_number.h"
#include "core/mesh/vertex_normals.h"

namespace caustics::beamtree {
namespace {

// What threads take at a time.
constexpr std::size_t edges_together = 2048;

/// A triangle's side from one place to another.
struct Edge {
    std::uint32_t low, high;
    bool upwards;
    std::uint32_t triangle;

    std::pair<std::uint32_t, std::uint32_t> ends() const { return {low, high}; }
};

std::vector<Edge> edges_of(const TriangleMesh& mesh, const std::vector<bool>& left_out,
                           int threads) {
    const std::vector<std::uint32_t> places = number_positions(mesh.positions, threads);
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (left_out[i]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = places[mesh.triangles[i][k]];
            const std::uint32_t b = places[mesh.triangles[i][(k + 1) % 3]];
            edges.push_back({std::min(a, b), std::max(a, b), a < b, i});
        }
    }
    return sort_by_number(
        std::span<const Edge>(edges), mesh.positions.size(), threads,
        [](const Edge& edge) { return edge.low; },
        [](const Edge& a, const Edge& b) {
            return std::tie(a.high, a.triangle, a.upwards) <
                   std::tie(b.high, b.triangle, b.upwards);
        });
}

// The corners of a triangle, seen from a point.
std::array<Vec3d, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle, const Vec3& from) {
    std::array<Vec3d, 3> seen;
    for (std::size_t i = 0; i < 3; ++i)
        seen[i] = mesh.positions[mesh.triangles[triangle][i]].cast<double>() - from.cast<double>();
    return seen;
}

}  // namespace

ClosedParts::ClosedParts(const TriangleMesh& mesh, const std::vector<bool>& left_out, int threads) {
    const std::vector<Edge> edges = edges_of(mesh, left_out, threads);
    throw_if_interrupted();
    const std::size_t count = mesh.triangles.size();
    Pieces pieces(count);
    std::vector<std::uint8_t> torn(count);  // a triangle with an edge of another kind
    parallel_chunks(threads, edges.size(), edges_together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i) {
            if (i > 0 && edges[i - 1].ends() == edges[i].ends()) continue;  // begun before
            std::size_t end = i + 1;
            while (end < edges.size() && edges[end].ends() == edges[i].ends()) ++end;
            const bool joined = end - i == 2 && edges[i].upwards != edges[i + 1].upwards;
            for (std::size_t k = i; k < end; ++k) {
                pieces.join(edges[i].triangle, edges[k].triangle);
                if (!joined)
                    std::atomic_ref(torn[edges[k].triangle]).store(1, std::memory_order_relaxed);
            }
        }
    });
    std::vector<bool> torn_piece(count);
    for (std::uint32_t i = 0; i < count; ++i)
        if (torn[i] != 0 || left_out[i]) torn_piece[pieces.find(i)] = true;
    std::vector<std::uint32_t> part_of_piece(count, open);
    std::vector<double> volumes;
    part_of_.assign(count, open);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t piece = pieces.find(i);
        if (torn_piece[piece]) continue;
        if (part_of_piece[piece] == open) {
            part_of_piece[piece] = static_cast<std::uint32_t>(volumes.size());
            volumes.push_back(0);
        }
        part_of_[i] = part_of_piece[piece];
        const auto [a, b, c] = corners(mesh, i, mesh.positions[0]);
        volumes[part_of_[i]] += a.dot(b.cross(c)) / 6;
    }
    for (const double volume : volumes) outward_.push_back(volume > 0);
}

ClosedParts::Hidden ClosedParts::hidden_from(const TriangleMesh& mesh,
                                             const LightSample& light) const {
    Hidden hidden;
    if (outward_.empty()) return hidden;
    hidden.parts_ = this;
    std::vector<double> seen(outward_.size());
    if (light.kind != LightSample::Kind::directional)
        for (std::uint32_t i = 0; i < part_of_.size(); ++i)
            if (part_of_[i] != open) {
                const auto [u, v, w] = corners(mesh, i, light.position);
                seen[part_of_[i]] += solid_angle(u, v, w);
            }
    // All round a light inside, nothing altogether for one outside.
    for (std::size_t part = 0; part < seen.size(); ++part)
        hidden.front_.push_back((std::abs(seen[part]) > 2 * pi_d) == outward_[part]);
    return hidden;
}

bool ClosedParts::Hidden::operator()(std::uint32_t triangle, bool front) const {
    if (parts_ == nullptr) return false;
    const std::uint32_t part = parts_->part_of_[triangle];
    return part != open && front_[part] == front;
}

}  // namespace caustics::beamtree

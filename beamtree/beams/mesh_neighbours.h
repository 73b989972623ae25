#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/caster_mesh.h"

namespace caustics::beamtree {

/// What lies side by side on a caster's mesh.
class MeshNeighbours {
public:
    static constexpr std::uint32_t none = ~0U;

    explicit MeshNeighbours(const CasterMesh& caster, int threads = 1);

    std::size_t vertex_count() const { return first_.size() - 1; }
    std::size_t triangle_count() const { return partners_.size(); }
    /// Vertices that share an edge with this one, in ascending order.
    std::span<const std::uint32_t> round(std::uint32_t vertex) const;
    /// The other triangle of a pair, or none: the two of a grid's cell, and elsewhere neighbours paired
    /// greedily, those first that come nearest to a parallelogram.
    std::uint32_t partner(std::uint32_t triangle) const { return partners_[triangle]; }

private:
    void find_rings(const CasterMesh& caster);
    void pair_cells(const CasterMesh& caster);
    void pair_others(const CasterMesh& caster);

    std::vector<std::uint32_t> first_;  ///< into `vertices_`, one a vertex and the end
    std::vector<std::uint32_t> vertices_;
    std::vector<std::uint32_t> partners_;
};

}  // namespace caustics::beamtree

#pragma once

#include <cstdint>
#include <vector>

#include "beamtree/beams/light_sample.h"
#include "core/mesh/mesh.h"

namespace caustics::beamtree {

/// The parts of a mesh that enclose a volume: pieces joined by edges each of which exactly two
/// triangles run along, in opposite ways. From outside such a part no light comes straight to the
/// inner sides of its polygons, and from inside none to the outer ones.
class ClosedParts {
public:
    ClosedParts() = default;
    /// Vertices at one position count as one. Triangles of `left_out` are not there.
    ClosedParts(const TriangleMesh& mesh, const std::vector<bool>& left_out, int threads = 1);

    /// The side of each part that a light cannot reach straight.
    class Hidden {
    public:
        /// Whether the light arrives on a hidden side when it arrives on the triangle's front
        /// (by its winding) or back. Always false for triangles of no closed part.
        bool operator()(std::uint32_t triangle, bool front) const;

    private:
        friend class ClosedParts;
        const ClosedParts* parts_ = nullptr;
        std::vector<bool> front_;  ///< one a part: the hidden side is the front
    };
    Hidden hidden_from(const TriangleMesh& mesh, const LightSample& light) const;

    std::size_t count() const { return outward_.size(); }

private:
    static constexpr std::uint32_t open = ~0U;

    std::vector<std::uint32_t> part_of_;  ///< one a triangle
    std::vector<bool> outward_;           ///< one a part: fronts face outwards
};

}  // namespace caustics::beamtree

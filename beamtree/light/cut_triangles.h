#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/ray_origin.h"
#include "core/mesh/mesh.h"

namespace caustics::beamtree {

/// Triangles of an exact shape's mesh that a set's beams cover in part, or not at all beside others that they cover: the
/// horizon cuts them, and the exact shape has its horizon elsewhere than its mesh. The preparation of roots takes them whole and clips
/// them itself.
class CutTriangles {
public:
    struct Whole {
        Beam beam;                    ///< the light of the triangle's pieces, and no corners
        std::array<Vec3, 3> corners;  ///< on the mesh
        Vec3d middle;                 ///< of the pieces, or of the triangle
        bool is_covered;              ///< in part
        Vec2d lit = Vec2d::Zero();    ///< Coordinates of a place whose light goes the set's way.
    };
    /// Finds Whole::lit. False if there is none, or if none of a triangle that is not covered is dark.
    using FindLit = std::function<bool(Whole&)>;

    /// No triangles.
    explicit CutTriangles(const BeamSet& set) : is_piece_(set.beams.size(), false) {}
    /// `origins`: one a ray of the set, on the mesh. Pieces of a triangle are at most four beams in a row, with corners
    /// on its edges.
    CutTriangles(const TriangleMesh& mesh, const std::vector<RayOrigin>& origins,
                 const BeamSet& set, const FindLit& find_lit);

    /// True for a beam that is a piece of a triangle that is taken whole.
    bool has(std::uint32_t beam) const { return is_piece_[beam]; }
    /// The triangles that follow a beam.
    std::span<const Whole> after(std::uint32_t beam) const {
        const auto found = wholes_.find(beam);
        return found == wholes_.end() ? std::span<const Whole>() : found->second;
    }

private:
    std::vector<bool> is_piece_;
    std::unordered_map<std::uint32_t, std::vector<Whole>> wholes_;
};

}  // namespace caustics::beamtree

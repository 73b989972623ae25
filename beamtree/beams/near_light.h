#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "beamtree/beams/lit_caster.h"

namespace caustics::beamtree {

/// Divides triangles of a caster's mesh to which a light is so near that their corners tell little of
/// what lies between: below a lamp just above water all corners of a triangle are lit at a grazing
/// angle, and nearly all light enters in its middle.
///
/// An edge is halved where the light sees it under more than 30 degrees (7.5 in glass that is a mesh
/// in the scene, and flat against that angle, as a pane of two triangles); where it is four times as long as it would be if the
/// mesh's triangles were spread evenly over all directions round the light; and where it is long
/// against the cone of a spot light and may lie in it. So the mesh bounds the number of pieces, however
/// near the light is. Whether an edge is halved depends on the edge alone: triangles that share it meet
/// in the same points.
///
/// The parts of an edge keep its verdict on flatness, and an edge inside a triangle has the widest angle of the
/// triangle's own: else a long edge that is just not flat would stay whole beside flat ones that are halved for
/// ever. Halvings of an edge are counted, and so end on any mesh.
class NearLight {
public:
    explicit NearLight(const LitCaster& surface);

    /// Whether the triangle has to be divided.
    bool is_near(const PieceCorners& corners) const;
    /// The pieces of one that has to be; any threads may ask. Throws UnsupportedScene where those of all triangles
    /// are too many: polygons much longer than wide, as of waves far higher than long, need one a width.
    std::vector<MeshPiece> pieces(const MeshPiece& triangle) const;

private:
    /// What an edge of a piece has from the edges that it comes from.
    struct Edge {
        double widest;  ///< angle under which the light may see it
        int halvings;
    };
    using Edges = std::array<Edge, 3>;  ///< from each corner to the next

    Vec3d from_light(const MeshPoint& point) const;
    Edge edge(const MeshPoint& a, const MeshPoint& b) const;
    static Edge half_of(const Edge& edge);
    static Edge edge_inside(const Edges& edges);
    bool is_wide(const MeshPoint& a, const MeshPoint& b, const Edge& edge) const;
    void divide(const MeshPiece& piece, const Edges& edges, std::vector<MeshPiece>& pieces) const;
    void count_piece() const;

    const LitCaster& surface_;
    const LightBender& bender_;
    const LightSample& light_;
    double most_;  ///< of the square of an edge's angle times the cosine at the surface
    bool is_glass_mesh_;
    mutable std::atomic<std::uint64_t> count_ = 0;  ///< of pieces; their sum knows no order
};

}  // namespace caustics::beamtree

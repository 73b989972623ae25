#pragma once

#include <vector>

#include "beamtree/beams/lit_caster.h"

namespace caustics::beamtree {

/// Divides triangles of a caster's mesh to which a light is so near that their corners tell little of
/// what lies between: below a lamp just above water all corners of a triangle are lit at a grazing
/// angle, and nearly all light enters in its middle.
///
/// An edge is halved where the light sees it under more than 30 degrees (7.5 in flat glass that is a mesh
/// in the scene, as a pane of two triangles); where it is four times as long as it would be if the
/// mesh's triangles were spread evenly over all directions round the light; and where it is long
/// against the cone of a spot light and may lie in it. So the mesh bounds the number of pieces, however
/// near the light is. Whether an edge is halved depends on the edge alone: triangles that share it meet
/// in the same points.
class NearLight {
public:
    explicit NearLight(const LitCaster& surface);

    /// Whether the triangle has to be divided.
    bool is_near(const PieceCorners& corners) const;
    /// The pieces of one that has to be.
    std::vector<MeshPiece> pieces(const MeshPiece& triangle) const;

private:
    bool is_wide(const MeshPoint& a, const MeshPoint& b) const;
    void divide(const MeshPiece& piece, std::vector<MeshPiece>& pieces) const;

    const LightBender& bender_;
    const LightSample& light_;
    double most_;  ///< of the square of an edge's angle times the cosine at the surface
    bool is_glass_mesh_;
};

}  // namespace caustics::beamtree

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// A regular subdivision: the triangles from `first_triangle` on are columns x rows cells, row by
/// row, of `cell_triangles` (1 or 2) each.
struct GridPatch {
    std::uint32_t first_triangle = 0;
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::uint32_t cell_triangles = 2;
};

/// Triangles with optional smooth vertex normals and texture coordinates.
/// `normals` and `uvs` are either empty or as long as `positions`. Counter-clockwise triangles
/// seen from the side of the geometric normal.
struct TriangleMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< unit; empty = shade with the geometric normal
    std::vector<Vec2> uvs;
    /// Positions before rounding, of a mesh that is not yet placed; empty where `positions` are exact enough
    /// (exact_positions.h).
    std::vector<Vec3d> exact_positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// How a tessellator divided its surface; empty for a mesh of any other origin.
    std::vector<GridPatch> patches;
};

/// Turns every triangle and normal round.
void flip(TriangleMesh& mesh);

/// Applies an affine map to positions and, by the inverse transpose, to normals (kept unit);
/// reverses the winding when the map mirrors, so that normals stay on their side. The mesh has no
/// exact positions any more. Throws InputError when the map is singular or not finite.
void transform(TriangleMesh& mesh, const Transform& to_world);

}  // namespace caustics

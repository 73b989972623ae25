#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"

namespace caustics {

/// What meshes of rows of vertices are put together from. All that adds vertices or rows throws
/// Interrupted when somebody asked.

/// Unit vector at `step` of `steps` round the circle. The last step is the first one bit for bit,
/// and the axes are met exactly, so that seams close without a gap.
Vec2d on_circle(int step, int steps);

inline double fraction(int part, int whole) { return static_cast<double>(part) / whole; }
/// -1 .. 1, exactly antisymmetric.
inline double symmetric(int part, int whole) {
    return static_cast<double>(2 * part - whole) / whole;
}

/// Takes the memory for a grid of so many cells at once: as it grows, a mesh of millions would be copied, and take up
/// to twice the memory.
void expect_grid(TriangleMesh& mesh, int columns, int rows);

/// The number of the new vertex.
std::uint32_t add_vertex(TriangleMesh& mesh, const Vec3d& position, const Vec3d& normal,
                         const Vec2d& uv);

/// Notes the subdivision of the triangles that follow.
void add_patch(TriangleMesh& mesh, int columns, int rows, std::uint32_t cell_triangles);

/// Two triangles a quad between two rows of (columns + 1) vertices, whose first ones are `lower`
/// and `upper`. Counter-clockwise where columns x rows points along the normal.
void add_row_triangles(TriangleMesh& mesh, std::uint32_t lower, std::uint32_t upper, int columns);

/// A patch of rows that follow each other; the first vertex of the first is `first`.
void add_grid_triangles(TriangleMesh& mesh, std::uint32_t first, int columns, int rows);

/// A triangle from each sector of a ring of (sectors + 1) vertices to its own copy of the pole,
/// which carries the uv of the sector's middle: `pole(u)` adds it.
template <class AddPole>
void add_fan(TriangleMesh& mesh, std::uint32_t ring, int sectors, bool pole_left, AddPole pole) {
    add_patch(mesh, sectors, 1, 1);
    for (int sector = 0; sector < sectors; ++sector) {
        const std::uint32_t tip = pole((sector + 0.5) / sectors);
        const std::uint32_t a = ring + static_cast<std::uint32_t>(sector);
        if (pole_left)
            mesh.triangles.push_back({tip, a, a + 1});
        else
            mesh.triangles.push_back({tip, a + 1, a});
    }
}

}  // namespace caustics

#pragma once

#include "core/mesh/mesh.h"

namespace caustics {

/// For each of the positions a number: equal positions, and they alone, have equal numbers.
std::vector<std::uint32_t> number_positions(const std::vector<Vec3>& positions, int threads = 1);

/// Makes every normal of the mesh unit, and gives each vertex that has none (mesh.normals empty,
/// or zero there) the sum of its triangles' unit normals weighted by their angles at it [Thürmer
/// and Wüthrich 1998]. Vertices at the same position share their triangles. Degenerate triangles
/// weigh nothing; a vertex whose sum vanishes takes the normal of its first triangle that is not
/// degenerate, or else +z.
void complete_normals(TriangleMesh& mesh);

/// The largest angle between a triangle's normal and that of one of its corners [rad]; 0 for a mesh
/// without normals, pi where one points backwards. Degenerate triangles do not count.
double largest_bend(const TriangleMesh& mesh);

}  // namespace caustics

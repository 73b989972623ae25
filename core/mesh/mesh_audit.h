#pragma once

#include <cstddef>

#include "core/mesh/mesh.h"

namespace caustics {

/// Edges that do not have as many triangles on one side as on the other: 0 for a closed mesh. Vertices
/// at the same position are one.
std::size_t open_edge_count(const TriangleMesh& mesh);

/// What a closed mesh encloses; below 0 where its front looks inwards [m^3].
double enclosed_volume(const TriangleMesh& mesh);

/// Triangles of one mesh that lie on one of another: the same three positions, facing either way.
std::size_t common_triangles(const TriangleMesh& one, const TriangleMesh& other);

}  // namespace caustics

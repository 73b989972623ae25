#pragma once

#include <cstddef>

#include "core/mesh/mesh.h"

namespace caustics {

/// Triangles of one mesh that lie on one of another: the same three positions, facing either way.
std::size_t common_triangles(const TriangleMesh& one, const TriangleMesh& other);

}  // namespace caustics

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace caustics {

/// Triangles of one mesh that lie on one of another: the same three positions, facing either way.
struct CommonTriangles {
    std::size_t first;   ///< index of the one mesh
    std::size_t second;  ///< index of the other, behind it
    std::size_t count;   ///< triangles of the first

    bool operator==(const CommonTriangles&) const = default;
};

/// All pairs of meshes that have triangles in common, in the order of their indices.
std::vector<CommonTriangles> common_triangles(std::span<const TriangleMesh* const> meshes);

}  // namespace caustics

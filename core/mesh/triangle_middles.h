#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh/mesh.h"

namespace caustics {

/// The middle of a triangle, and its unit normal by its winding.
struct TriangleMiddle {
    Vec3 place;
    Vec3 normal;
};

/// Of at most `most` triangles spread over a mesh; those without area are left out.
std::vector<TriangleMiddle> triangle_middles(const TriangleMesh& mesh, std::size_t most);

}  // namespace caustics

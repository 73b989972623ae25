#pragma once

#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// The half-space normal . x <= distance; the normal is unit.
struct HalfSpace {
    Vec3d normal = Vec3d::UnitZ();
    double distance = 0;  ///< from the origin, along the normal [m]
};

/// A convex solid: its vertices, and for each half-space the vertices of its facet, counter-clockwise
/// seen from outside; empty where the half-space cuts nothing off.
struct Polytope {
    std::vector<Vec3d> vertices;
    std::vector<std::vector<std::uint32_t>> facets;
};

/// What is common to the half-spaces. Vertices nearer to each other than a millionth of the solid's
/// size are one. Throws InputError for a solid without volume or bounds.
Polytope intersect(const std::vector<HalfSpace>& planes);

}  // namespace caustics

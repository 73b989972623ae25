#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// Triangles of a planar polygon without holes, as indices of its corners, wound as it is: always as
/// many as corners less two, by cutting off ears (Meisters 1975); a convex polygon becomes a fan
/// about its first corner. Corners on a line and corners that coincide are taken; what crosses
/// itself is cut somehow. Throws InputError for what would take too long: more than some 4,000 corners.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<Vec3d>& corners);

}  // namespace caustics

#pragma once

#include <vector>

#include "core/geometry/shape.h"
#include "core/illumination_map/texel_grid.h"

namespace caustics {

/// The grid over a receiver's texture coordinates; those of sphere, cylinder and disk go round.
TexelGrid texel_grid(const Shape& shape, int resolution);

/// The area of the surface that each texel stands for [m^2]: its share (TexelGrid) of every place,
/// summed over the surface. By Gauss's rule over the parametrisation of an exact shape, exactly for
/// the triangles of a mesh. Throws UnsupportedScene naming the shape where texture coordinates do not
/// name one place each: a mesh without them, outside the unit square, or overlapping in it.
std::vector<double> texel_areas(const Shape& shape, const TexelGrid& grid);

}  // namespace caustics

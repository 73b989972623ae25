#pragma once

#include "core/geometry/shape.h"

namespace caustics {

/// The cube [-1,1]^3 (those of exact shapes are in core/exact_shapes). Vertices and vertex normals of a mesh lie
/// exactly (to float) on its shape; uv as Mitsuba's.
/// n x n quads a face, flat normals (vertices are not shared between faces).
TriangleMesh tessellate_cube(int n);
/// The mesh of an exact shape in the world frame, facing as the shape does. A sphere takes n >= 2.
TriangleMesh tessellate_shape(const Shape& shape, int n);

}  // namespace caustics

#pragma once

#include "core/geometry/heightfield.h"
#include "core/geometry/mesh.h"
#include "core/geometry/shape.h"

namespace caustics {

/// Meshes of the analytic shapes in their local frames (Mitsuba's: rectangle [-1,1]^2 and unit
/// disk at z = 0 facing +z, unit sphere, unit cylinder along z in [0,1] facing outwards, cube
/// [-1,1]^3). Vertices and vertex normals lie exactly (to float) on the shape; uv as Mitsuba's.
/// `resolution` n >= 1 counts as said for each.

/// Cells along x and y; one number is for both.
struct Cells {
    // Implicit: a number stands for both.
    Cells(int both) : x(both), y(both) {}
    Cells(int along_x, int along_y) : x(along_x), y(along_y) {}
    int x, y;
};
/// Quads of two triangles each.
TriangleMesh tessellate_rectangle(Cells n);
/// n rings of 4n sectors.
TriangleMesh tessellate_disk(int n);
/// n bands of latitude, 2n of longitude; the poles are fans. n >= 2.
TriangleMesh tessellate_sphere(int n);
/// 4n sectors round the axis, n bands along it (open ends).
TriangleMesh tessellate_cylinder(int n);
/// n x n quads a face, flat normals (vertices are not shared between faces).
TriangleMesh tessellate_cube(int n);
/// Quads of two triangles each, normals from the exact gradient.
TriangleMesh tessellate_heightfield(const SineHeightfield& field, Cells n);

/// The mesh of an exact shape in the world frame, facing as the shape does. A sphere takes n >= 2.
TriangleMesh tessellate_shape(const Shape& shape, int n);

}  // namespace caustics

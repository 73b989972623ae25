#pragma once

#include <string>

#include "core/mesh/mesh.h"

namespace caustics {

/// The mesh of a whole OBJ file: its v, vt, vn and f lines. Names, groups, smoothing groups, materials, points and
/// lines are left out; free-form curves and surfaces are refused. Corners of faces that agree in everything, exactly,
/// are one vertex, in the order in which the triangles name them. Normals are as in the file, zero where a corner has
/// none beside others that have. Throws InputError, one line beginning with `name` and the line's number.
TriangleMesh read_obj(const std::string& bytes, const std::string& name);

}  // namespace caustics

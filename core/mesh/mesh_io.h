#pragma once

#include <filesystem>

#include "core/mesh/mesh.h"

namespace caustics {

/// What to do with a mesh file's normals, as Mitsuba's `obj` and `ply`.
struct MeshLoadOptions {
    bool face_normals = false;  ///< shade with geometric normals, ignoring those of the file
    bool flip_normals = false;  ///< turns all triangles and normals round, at last
    bool orient = false;        ///< turns triangles first (mesh_doctor.h)
};

/// Reads an OBJ or PLY (ASCII, little- or big-endian) file: n-gons triangulated, normals and
/// uv kept where the file has them; vertices without a normal get an angle-weighted one (see
/// vertex_normals.h) unless `face_normals`. Throws InputError with one line for a missing,
/// truncated, broken or empty file, out-of-range indices, or coordinates that are not finite.
///
/// All objects and groups of an OBJ file are one mesh; their names, smoothing groups, materials,
/// vertex colours, points and lines are left out, and so are elements and properties of a PLY
/// file that TriangleMesh does not hold. Positions are those of the file in double precision until the mesh is placed,
/// where floats are too coarse for them. As Mitsuba's `flip_tex_coords` has it by default, v is
/// turned to 1 - v for OBJ and kept for PLY. Vertices of a PLY file keep their numbers. Where some
/// vertices of an OBJ file have uv, those without have (0, 0). Degenerate triangles are kept.
TriangleMesh load_mesh(const std::filesystem::path& file, const MeshLoadOptions& options);

}  // namespace caustics

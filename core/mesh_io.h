#pragma once

#include <filesystem>

#include "core/mesh.h"

namespace caustics {

/// What to do with a mesh file's normals, as Mitsuba's `obj` and `ply`.
struct MeshLoadOptions {
    bool face_normals = false;  ///< shade with geometric normals, ignoring those of the file
    bool flip_normals = false;
};

/// Reads an OBJ or PLY (ASCII, little- or big-endian) file: n-gons triangulated, normals and
/// uv kept where the file has them; without normals, area-free angle-weighted vertex normals are
/// made unless `face_normals`. Throws InputError with one line for a missing, truncated, broken or
/// empty file, out-of-range indices, or coordinates that are not finite.
TriangleMesh load_mesh(const std::filesystem::path& file, const MeshLoadOptions& options);

}  // namespace caustics

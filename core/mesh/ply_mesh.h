#pragma once

#include <string>

#include "core/mesh/mesh.h"

namespace caustics {

/// The mesh of a whole PLY file, ASCII, little- or big-endian: its elements `vertex` (positions; normals and texture
/// coordinates where all of them are given) and `face`. Other elements and properties are left out, and so are
/// vertices that no face has. Throws InputError, one line beginning with `name`.
TriangleMesh read_ply(const std::string& bytes, const std::string& name);

}  // namespace caustics

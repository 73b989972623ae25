#pragma once

#include <string>

#include "core/material/texture.h"
#include "core/mesh/mesh.h"

namespace caustics::experiments {

/// A mesh as a binary little-endian PLY file: x y z, and where the mesh has them nx ny nz and u v.
std::string ply_bytes(const TriangleMesh& mesh);

/// A texture's texels as a little-endian PFM file (linear float32 RGB).
std::string pfm_bytes(const Bitmap& bitmap);

}  // namespace caustics::experiments

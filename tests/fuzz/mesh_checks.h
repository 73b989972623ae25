#pragma once

#include <cmath>

#include "core/mesh/mesh_io.h"
#include "tests/fuzz/reading.h"

namespace caustics::fuzz {

/// What holds for every mesh that was read.
inline void require_sound(const TriangleMesh& mesh) {
    require(!mesh.triangles.empty(), "a mesh without triangles");
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(),
            "not one normal a vertex");
    require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size(), "not one uv a vertex");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            require(corner < mesh.positions.size(), "a corner that is no vertex");
    for (const Vec3& position : mesh.positions)
        require(position.allFinite(), "a position that is not finite");
    for (const Vec2& uv : mesh.uvs) require(uv.allFinite(), "a uv that is not finite");
    for (const Vec3& normal : mesh.normals)
        require(std::abs(normal.norm() - 1) < 1e-3F, "a normal that is not unit");
}

/// Reads a mesh file with and without smooth normals.
inline bool read_mesh(const std::filesystem::path& file, TriangleMesh& mesh) {
    const bool read = taken(Naming::file, [&] { mesh = load_mesh(file, {}); });
    if (!read) return false;
    require_sound(mesh);
    const TriangleMesh flat = load_mesh(file, {.face_normals = true, .flip_normals = true});
    require_sound(flat);
    require(flat.triangles.size() == mesh.triangles.size(), "other triangles when flat");
    return true;
}

}  // namespace caustics::fuzz

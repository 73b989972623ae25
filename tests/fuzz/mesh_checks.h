#pragma once

#include <cmath>
#include <string>

#include "core/mesh/mesh_io.h"
#include "core/mesh/vertex_normals.h"
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

/// Reads a mesh from memory, and one of sixteen from its file as well, with and without smooth normals.
template <class Read>
bool read_mesh(const std::string& name, const std::string& bytes, const Read& read_bytes,
               TriangleMesh& mesh) {
    static const std::string file = named(name).string();
    const bool read = taken(Naming::file, [&] {
        mesh = read_bytes(bytes, file);
        complete_normals(mesh);
    });
    if (read) require_sound(mesh);
    if (!one_in(16, bytes)) return read;
    put(name, bytes);
    require(!taken(Naming::file, [&] { load_mesh(named("mesh.stl"), {}); }), "a mesh of any name");
    TriangleMesh flat;
    const bool again = taken(Naming::file, [&] {
        flat = load_mesh(file, {.face_normals = true, .flip_normals = true});
        require_sound(flat);
        const TriangleMesh smooth = load_mesh(file, {});
        require_sound(smooth);
        require(smooth.triangles == mesh.triangles, "other triangles from its file");
        require(std::isfinite(largest_bend(smooth)), "no angle between normals");
    });
    require(again == read, "taken from its file alone, or from memory alone");
    require(flat.triangles.size() == mesh.triangles.size(), "other triangles when flat");
    return read;
}

}  // namespace caustics::fuzz

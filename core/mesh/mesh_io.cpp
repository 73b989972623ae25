#include "core/mesh/mesh_io.h"

#include <assimp/scene.h>
#include <array>
#include <assimp/Importer.hpp>
#include <map>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/lower_case.h"
#include "core/math/polygon.h"
#include "core/mesh/mesh_source.h"
#include "core/mesh/vertex_normals.h"

namespace caustics {
namespace {

Vec3 to_vec(const aiVector3D& v) { return {v.x, v.y, v.z}; }

void append(TriangleMesh& mesh, const aiMesh& part) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        mesh.positions.push_back(to_vec(part.mVertices[i]));
        if (part.HasNormals()) mesh.normals.push_back(to_vec(part.mNormals[i]));
        if (part.HasTextureCoords(0))
            mesh.uvs.push_back(to_vec(part.mTextureCoords[0][i]).head<2>());
    }
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& face = part.mFaces[i];
        corners.clear();
        for (unsigned c = 0; c < face.mNumIndices; ++c)
            corners.push_back(mesh.positions[first + face.mIndices[c]]);
        for (const auto& [a, b, c] : triangulate_polygon(corners))
            mesh.triangles.push_back(
                {first + face.mIndices[a], first + face.mIndices[b], first + face.mIndices[c]});
    }
}

// assimp does nothing here but read what check_obj and check_ply wrote: post-processing would merge,
// reorder or drop (its 5.4 loses triangles of polygons with some hundred corners).
TriangleMesh import(const MeshSource& source, const char* format, const std::string& name) {
    Assimp::Importer importer;
    const aiScene* scene =
        importer.ReadFileFromMemory(source.text.data(), source.text.size(), 0, format);
    if (scene == nullptr || scene->mNumMeshes != 1)
        throw InputError(name + ": " +
                         (scene == nullptr ? importer.GetErrorString() : "not one mesh"));
    TriangleMesh mesh;
    append(mesh, *scene->mMeshes[0]);
    if (mesh.triangles.size() != source.triangles)
        throw InputError(name + ": " + std::to_string(source.triangles) + " triangles expected, " +
                         std::to_string(mesh.triangles.size()) + " read");
    return mesh;
}

// assimp gives every corner of an OBJ face its own vertex. Corners that agree in everything,
// exactly, become one again; nothing moves.
void join_corners(TriangleMesh& mesh) {
    const auto coordinate = [](const auto& vectors, std::size_t vertex, int axis) {
        return vectors.empty() ? 0.0F : vectors[vertex][axis];
    };
    std::map<std::array<float, 8>, std::uint32_t> seen;
    TriangleMesh joined;
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            std::array<float, 8> key{};
            for (int axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<std::size_t>(axis);
                key[at] = mesh.positions[corner][axis];
                key[3 + at] = coordinate(mesh.normals, corner, axis);
                if (axis < 2) key[6 + at] = coordinate(mesh.uvs, corner, axis);
            }
            const auto [entry, is_new] =
                seen.try_emplace(key, static_cast<std::uint32_t>(joined.positions.size()));
            if (is_new) {
                joined.positions.push_back(mesh.positions[corner]);
                if (!mesh.normals.empty()) joined.normals.push_back(mesh.normals[corner]);
                if (!mesh.uvs.empty()) joined.uvs.push_back(mesh.uvs[corner]);
            }
            corner = entry->second;
        }
    }
    joined.triangles = std::move(mesh.triangles);
    mesh = std::move(joined);
}

// Vertices that no triangle has are no part of the surface, nor of its bounds.
void drop_unused_vertices(TriangleMesh& mesh) {
    constexpr std::uint32_t unused = ~0U;
    std::vector<std::uint32_t> place(mesh.positions.size(), unused);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) place[corner] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < place.size(); ++i) {
        if (place[i] == unused) continue;
        mesh.positions[count] = mesh.positions[i];
        if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
        if (!mesh.uvs.empty()) mesh.uvs[count] = mesh.uvs[i];
        place[i] = count++;
    }
    mesh.positions.resize(count);
    if (!mesh.normals.empty()) mesh.normals.resize(count);
    if (!mesh.uvs.empty()) mesh.uvs.resize(count);
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) corner = place[corner];
}

TriangleMesh load_obj(const std::string& bytes, const std::string& name) {
    TriangleMesh mesh = import(check_obj(bytes, name), "obj", name);
    for (Vec2& uv : mesh.uvs) uv.y() = 1 - uv.y();
    join_corners(mesh);
    return mesh;
}

TriangleMesh load_ply(const std::string& bytes, const std::string& name) {
    TriangleMesh mesh = import(check_ply(bytes, name), "ply", name);
    drop_unused_vertices(mesh);
    return mesh;
}

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& file, const MeshLoadOptions& options) {
    const std::string extension = lower_case(file.extension().string());
    if (extension != ".obj" && extension != ".ply")
        throw InputError(file.string() + ": unknown mesh format '" + extension +
                         "' (known: .obj, .ply)");
    const std::string bytes = read_whole_file(file);
    if (bytes.empty()) throw InputError(file.string() + ": the file is empty");
    TriangleMesh mesh =
        extension == ".obj" ? load_obj(bytes, file.string()) : load_ply(bytes, file.string());
    if (options.face_normals)
        mesh.normals.clear();
    else
        complete_normals(mesh);
    if (options.flip_normals) flip(mesh);
    return mesh;
}

}  // namespace caustics

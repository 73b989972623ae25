#include "core/mesh/mesh_io.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/lower_case.h"
#include "core/mesh/exact_positions.h"
#include "core/mesh/mesh_doctor.h"
#include "core/mesh/obj_mesh.h"
#include "core/mesh/ply_mesh.h"
#include "core/mesh/vertex_normals.h"

namespace caustics {
namespace {

void orient_file(TriangleMesh& mesh, const std::filesystem::path& file) {
    try {
        orient(mesh);
    } catch (const InputError& error) {
        throw InputError(file.string() + ": " + error.what());
    }
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
        extension == ".obj" ? read_obj(bytes, file.string()) : read_ply(bytes, file.string());
    if (options.face_normals) mesh.normals.clear();
    in_own_frame(mesh, [&](TriangleMesh& own) {
        if (options.orient) orient_file(own, file);
        if (!options.face_normals) complete_normals(own);
    });
    if (options.flip_normals) flip(mesh);
    return mesh;
}

}  // namespace caustics

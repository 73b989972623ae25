#pragma once

#include <string>
#include <vector>

#include "core/mesh/mesh_doctor.h"
#include "core/scene/scene.h"

namespace caustics::experiments {

struct ExaminedMesh {
    std::uint32_t shape;  ///< index into Scene::shapes
    MeshDiagnosis diagnosis;
};

/// The casters that are meshes, and the receivers and lights among meshes that have one side only.
std::vector<ExaminedMesh> examine_meshes(const Scene& scene);

/// Notes on meshes for the user, one line each: faces that point the wrong way, where that changes light (of
/// dielectrics, and of what is black or dark from behind), holes and double triangles of dielectrics, parts that
/// `orient` could not tell the outside of, and a caster whose size suggests that its file has another unit.
std::vector<std::string> mesh_notes(const Scene& scene, const std::vector<ExaminedMesh>& meshes);
std::vector<std::string> mesh_notes(const Scene& scene);

/// A diagnosis in a line of `info`, each item after a comma; empty for one closed part without flaws.
std::string listed(const MeshDiagnosis& diagnosis);

}  // namespace caustics::experiments

#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/run/mesh_notes.h"

namespace caustics::experiments {

/// The lines of `info` about shapes, one each: its kind and use, the parts and flaws of a mesh, and whether a caster
/// lies on another one.
std::vector<std::string> shape_lines(const Scene& scene, const std::vector<ExaminedMesh>& meshes);

}  // namespace caustics::experiments

#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace caustics::experiments {

/// What `info` says of each shape, a line each: its kind and use, and of a mesh that is a caster its
/// open edges, whether glass faces inwards, and whether it lies on another caster.
std::vector<std::string> shape_lines(const Scene& scene);

}  // namespace caustics::experiments

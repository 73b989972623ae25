#pragma once

#include "core/geometry/shape.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

const std::vector<std::string>& shape_types();
const std::vector<std::string>& later_shape_types();
/// A shape with its nested bsdf and emitter; meshes are loaded or tessellated here. It still has to
/// be put into the scene's frame (frame.h).
Shape read_shape(const std::string& name, const JsonNode& node, Assets& assets);

}  // namespace caustics::scene_file

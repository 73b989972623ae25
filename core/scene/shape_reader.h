#pragma once

#include "core/geometry/shape.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics::scene_file {

const std::vector<std::string>& shape_types();
const std::vector<std::string>& later_shape_types();
/// A shape with its nested bsdf and emitter; meshes are loaded or tessellated here. Its `to_world` goes to the
/// world, and a mesh lies in a frame of its own, until it is put into the scene's frame (scene_frame.h).
Shape read_shape(const std::string& name, const JsonNode& node, Assets& assets);
/// All types, with their keys and those of what is in them.
Objects shape_keys();
/// Bounds of such a shape in the world.
Eigen::AlignedBox3d world_bounds(const Shape& shape);

}  // namespace caustics::scene_file

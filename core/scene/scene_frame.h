#pragma once

#include <vector>

#include "core/geometry/shape.h"

namespace caustics::scene_file {

/// The scene's frame: coordinates relative to a point among the casters, so that floats resolve them as
/// well far from the world's origin as near it. Below, a shape's `to_world` still goes to the world,
/// and a mesh lies in its own frame.

/// The world's origin where that is no farther from each caster than 8 times its size; else the mean
/// of the casters' centres, each weighted by 1 / size^2 (the smallest needs it most). Without casters
/// all shapes are asked.
Vec3d frame_origin(const std::vector<Shape>& shapes);

/// Puts a shape into the frame: its `to_world` goes there, or is applied to its mesh.
void place(Shape& shape, const Vec3d& origin);

}  // namespace caustics::scene_file

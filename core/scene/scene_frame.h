#pragma once

#include <vector>

#include "core/geometry/shape.h"

namespace caustics::scene_file {

/// The scene's frame: coordinates relative to a point among the casters, so that floats resolve them as
/// well far from the world's origin as near it. Below, a shape's `to_world` still goes to the world,
/// and a mesh lies in its own frame.

/// The world's origin where that is no farther from each caster than 8 times its size; else the mean
/// of the casters' centres, each weighted by 1 / size^2 (the smallest needs it most). Without casters
/// all shapes are asked. `boxes` are the shapes' bounds in the world.
Vec3d frame_origin(const std::vector<Shape>& shapes, const std::vector<Eigen::AlignedBox3d>& boxes);

/// Whether floats resolve a shape of these bounds in the frame: it is wider than a millionth of its distance
/// from the frame's origin.
bool is_resolved(const Eigen::AlignedBox3d& box, const Vec3d& origin);

/// Puts a shape into the frame: its `to_world` goes there, or is applied to its mesh. Throws InputError where floats
/// are too coarse for the mesh's triangles.
void place(Shape& shape, const Vec3d& origin);

}  // namespace caustics::scene_file

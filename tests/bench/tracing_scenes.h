#pragma once

#include "core/scene/scene.h"

namespace caustics::bench {

/// A wavy pool of 2 x 2 m over a floor 1 m below, seen from a point light: 2 resolution^2 triangles
/// of water (128: 33 k, 512: 524 k).
SceneDesc pool_scene(int resolution);
/// Its waves `waves` times as high.
SceneDesc pool_scene(int resolution, double waves);
/// A glass ball over a floor, lit from the side: 4 resolution (resolution - 1) triangles
/// (128: 65 k, 256: 261 k).
SceneDesc ball_scene(int resolution);

}  // namespace caustics::bench

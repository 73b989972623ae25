#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace caustics::beamtree {

/// Bounds that every beam's way is held against: taken once a scene, since a mesh's take all its
/// vertices.
struct SceneBoxes {
    std::vector<Box> casters;
    std::vector<Box> receivers;
    float diameter = 0;  ///< of all surfaces [m]
};

SceneBoxes scene_boxes(const Scene& scene);

}  // namespace caustics::beamtree

#pragma once

#include <vector>

#include "beamtree/beams/beam.h"
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

/// Whether a beam, however far it goes, may come within `margin` [m] of a receiver's bounds; where it says no, no
/// point there is inside the beam on any plane. `is_curved`: its rays may go beyond those of its corners, the farther the more these part.
bool may_meet_receiver(const SceneBoxes& boxes, const BeamSet& set, const Beam& beam, float margin,
                       bool is_curved = false);

}  // namespace caustics::beamtree

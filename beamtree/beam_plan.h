#pragma once

#include <span>

#include "beamtree/beam_tree_params.h"
#include "beamtree/pencils/pencil_paths.h"

namespace caustics::beamtree {

/// Which of a scene's light beams carry, and which pencils do.
struct BeamPlan {
    int beam_events = 0;        ///< beams carry the light of up to so many specular events; 0: none
    bool needs_pencils = true;  ///< there is other light
    double beam_share =
        0;  ///< of the caustic on receivers, as a sample tells; 1 where `beam_events` is given
};

/// Beams carry what they carry at a few times the cost of a photon map: all light, where all beams are few; else light of
/// one event, where that is most of the caustic; else none, for behind glass polygons would be cut again and again. The plan
/// rests on counts of some pencils and of some polygons drawn at random, so that it is the same on every machine.
/// `beam_events` decides where it is given.
BeamPlan plan_beams(const Scene& scene, const BeamTreeParams& params, const RunOptions& options);

/// Pencils of a scene, their lights, and what they tell of all caustic light.
struct ScenePencils {
    std::vector<LightSample> lights;
    TracedPencils traced;

    /// The light of up to so many events over all of it, as it comes to receivers; 1 where none does.
    double share_up_to(int most_events) const;
};

/// Traces about `count` pencils, which start all over area lights.
ScenePencils trace_scene_pencils(const Scene& scene, const BeamTreeParams& params,
                                 std::uint64_t count, const RunOptions& options);

}  // namespace caustics::beamtree

#pragma once

#include <vector>

#include "beamtree/beams/flux_balance.h"
#include "beamtree/beams/trace_progress.h"
#include "beamtree/tracing/beam_path.h"
#include "beamtree/tracing/next_beams.h"
#include "beamtree/tracing/scene_boxes.h"

namespace caustics::beamtree {

/// What one set's light does next.
struct NextSets {
    std::vector<Level>
        sets;  ///< of all casters it meets, after each event; their parent is the level
    /// Of a beam: does light of its last leg come to something else than a caster, as far as its corners tell?
    std::vector<bool> stays;
    std::vector<RestPhoton> rest;  ///< of light that is left out
};

/// Follows a level's rays to the next surfaces (its `arrivals`) and makes the beams that go on from there;
/// those with less than `least` are left out, counted by `balance` and completed by `rest`.
NextSets next_sets(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
                   Level& level, const LeastLight& least, const RestPhotons& rest,
                   FluxBalance& balance, int threads, const ProgressPart& part);

}  // namespace caustics::beamtree

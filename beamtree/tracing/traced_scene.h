#pragma once

#include <string>
#include <vector>

#include "beamtree/beams/beam_params.h"
#include "beamtree/beams/behind_polygons.h"
#include "beamtree/beams/flux_balance.h"
#include "beamtree/tracing/beam_tracing.h"

namespace caustics::beamtree {

/// The beams of a scene, all lights and casters.
struct TracedScene {
    std::vector<CasterMesh> casters;
    std::vector<BeamSet> sets;
    std::vector<RestPhoton> rest;  ///< light that beams leave out
    Completion completion;         ///< what of that light photons carry
    FluxBalance balance;
    DriftAccount drift;
    double least_light =
        0;  ///< of beams of several events that the budget has room for [W]; 0: it has for all
    std::uint64_t unreceived = 0;  ///< beams that pass all receivers' bounds: not kept
    WallsBehind walls;             ///< of the caster that has most of them
    int wavelengths = 0;           ///< of each light; 0: nothing disperses it

    /// polygons, beams, their bytes and what was left out; how normals and meshes were come by.
    BuildReport report() const;
    /// The mesh of a shape.
    const CasterMesh& caster(std::uint32_t shape) const;
};

/// How beams of up to so many events are traced to be counted, `most` of them.
TraceSettings settings_of_beams(const BeamParams& params, int most_events, std::uint64_t most);

/// Phase "beams". Beams that pass all receivers, squares of a side `footprint` [m] round their points too, are not
/// kept. TraceSettings tells of `root_events`. `rest` completes light that beams leave out; without, it is lost.
/// Throws UnsupportedScene, in the name of `method`, where beams lose more than half of the light on its way to
/// further events.
TracedScene trace_scene(const Scene& scene, const std::string& method, const BeamParams& params,
                        const RunOptions& options, Intensity intensity = Intensity::area,
                        float footprint = 0, Completion rest = {},
                        int root_events = TraceSettings{}.root_events);

}  // namespace caustics::beamtree

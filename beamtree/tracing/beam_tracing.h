#pragma once

#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/caster_mesh.h"
#include "beamtree/tracing/beam_bounces.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// Beams of one caster lit by one light sample: those reflected and those refracted (row B1).
/// Vertex rays follow the vertex normals; their Fresnel shares, colours and the absorption on the
/// way from the light weigh the flux, which is strength x solid angle x their mean. Where the light
/// is bent at some corners of a triangle only (total internal reflection, a normal turned away, the
/// horizon of an area light), the triangle is cut by bisection along its edges. Where its corners do
/// not tell what it does (all dark and light inside, rays that part by 60 degrees), it is quartered,
/// up to five times: a mesh's triangle may send several beams. Polygons of a closed caster send
/// nothing from the side that the light cannot reach; what else stands between surfaces is not known
/// here.
std::array<BeamSet, 2> trace_beams(const Scene& scene, const CasterMesh& caster,
                                   const LightSample& light);

/// How a beam's light is computed at a point (row B8, and beyond the paper row B13).
enum class Intensity {
    area,    ///< flux / area of the caustic polygon [CC95 (11)]: right to first order at a point
    refined  ///< by the rays' spreads: right to second order where the light is smooth
};

struct TraceSettings {
    Intensity intensity = Intensity::area;
    int max_bounces = 1;
};

/// All sets that hold a beam: lights outermost, then first casters, reflection before refraction, each
/// set before those that its light reaches. With `refined` they have spreads.
TracedBeams trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                            const std::vector<LightSample>& lights, const TraceSettings& settings,
                            const RunOptions& options);
/// Those of the paper: one event, without spreads.
std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options);

}  // namespace caustics::beamtree

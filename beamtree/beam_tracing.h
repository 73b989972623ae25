#pragma once

#include <vector>

#include "beamtree/beam.h"
#include "beamtree/caster_mesh.h"
#include "core/caustic_estimator.h"

namespace caustics {

/// Beams of one caster lit by one light sample: those reflected and those refracted (row B1).
/// Vertex rays follow the vertex normals; their Fresnel shares, colours and the absorption on the
/// way from the light weigh the flux, which is strength x solid angle x their mean. Where the light
/// is bent at some corners of a triangle only (total internal reflection, a normal turned away, the
/// horizon of an area light), the triangle is cut by bisection along its edges, the same way from
/// both of its sides. Nothing is known here about what stands between surfaces.
std::array<BeamSet, 2> trace_beams(const Scene& scene, const CasterMesh& caster,
                                   const LightSample& light);

/// All of them that hold a beam: lights outermost, then casters, reflection before refraction.
std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options);

/// Flux of the beams that are lit, and of those among them that next meet another specular surface,
/// judged at each beam's middle [W, mean of channels]. The method follows one event only.
struct FluxBalance {
    double lit = 0;
    double to_casters = 0;
    double share() const { return lit > 0 ? to_casters / lit : 0; }
};
FluxBalance flux_balance(const Scene& scene, const std::vector<BeamSet>& sets,
                         const RunOptions& options);

}  // namespace caustics

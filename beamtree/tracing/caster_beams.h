#pragma once

#include <array>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/caster_mesh.h"
#include "beamtree/tracing/beam_bounces.h"

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

/// The light that they have [W, mean of channels].
double first_flux(const Scene& scene, const CasterMesh& caster, const LightSample& light,
                  int threads);

/// Beams of one caster lit by one light sample, after all events; only counted once they are more than the
/// budget. Spreads want `neighbours`.
TracedBeams trace_beams(const Scene& scene, const SceneBoxes& boxes, const CasterMesh& caster,
                        const MeshNeighbours* neighbours, const LightSample& light,
                        const TraceSettings& settings, BeamBudget& budget,
                        const ProgressPart& part);

}  // namespace caustics::beamtree

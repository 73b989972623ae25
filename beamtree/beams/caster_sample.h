#pragma once

#include <cstdint>

#include "beamtree/beams/caster_mesh.h"
#include "core/math/rng.h"

namespace caustics::beamtree {

/// So many of a mesh's triangles at random, each drawn from all, as the polygons of a caster: what is told of them is
/// told of all, in a time that does not grow with their number. No side of them is taken to be out of the light's reach
/// (ClosedParts): that would take all polygons. The caller says which shape it is.
CasterMesh draw_polygons(const TriangleMesh& mesh, std::size_t count, Rng& rng);

}  // namespace caustics::beamtree

#pragma once

#include <cstdint>

#include "beamtree/beams/caster_mesh.h"
#include "core/math/rng.h"

namespace caustics::beamtree {

/// So many of a caster's polygons at random, each drawn from all, as a mesh of their own: what is told of them is told
/// of all, in a time that does not grow with their number. No side of them is taken to be out of the light's reach
/// (ClosedParts): that would take all polygons.
CasterMesh draw_polygons(const CasterMesh& caster, std::size_t count, Rng& rng);

/// One of a scene's casters to draw from, without what caster_meshes finds out of all polygons. `resolution` is
/// that of caster_meshes.
CasterMesh undivided_caster(const Scene& scene, std::uint32_t shape, int resolution);

}  // namespace caustics::beamtree

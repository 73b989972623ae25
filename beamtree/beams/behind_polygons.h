#pragma once

#include "beamtree/beams/lit_caster.h"

namespace caustics::beamtree {

/// Throws UnsupportedScene where the light lies between a curved exact shape and a polygon that stands for it: near the
/// wall inside a ball, or in a trough of waves. Polygons lit from their other side send its light nowhere.
void refuse_light_behind_polygons(const Scene& scene, const LitCaster& surface);

/// Walls that are not much thicker than polygons are flat: another surface lies below a curved exact shape by less than
/// twice as much as the polygon that stands for it, so that some of its light starts on the wrong side of that.
struct WallsBehind {
    double share = 0;  ///< of the caster's polygons
    double finer = 1;  ///< how many times as fine polygons would have to be
};
/// By some hundreds of a caster's polygons.
WallsBehind walls_behind_polygons(const Scene& scene, const CasterMesh& caster);

}  // namespace caustics::beamtree

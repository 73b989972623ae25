#pragma once

#include "beamtree/beams/lit_caster.h"

namespace caustics::beamtree {

/// Throws UnsupportedScene where the light lies between a curved exact shape and a polygon that stands for it: near the
/// wall inside a ball, or in a trough of waves. Polygons lit from their other side send its light nowhere.
void refuse_light_behind_polygons(const Scene& scene, const LitCaster& surface);

}  // namespace caustics::beamtree

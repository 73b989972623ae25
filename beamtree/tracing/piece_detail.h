#pragma once

#include <array>

#include "beamtree/tracing/beam_path.h"
#include "beamtree/tracing/scene_boxes.h"

namespace caustics::beamtree {

// Whether a piece of a flat first surface is too large for what its light meets: a pane of two
// triangles shines on a ball that turns away within a hundredth of them. (Curved surfaces are as fine as
// their mesh.)

/// Whether two rays from a flat surface meet one that turns so much from one to the other that a beam
/// between them is coarse.
bool is_coarse(const RayOrigin& from, const RayArrival& a, const RayOrigin& other,
               const RayArrival& b);
/// Whether there is a caster that the rays of a piece may go round: it is small against the way from
/// one to the other, and about where their light goes.
bool may_pass_round_caster(const SceneBoxes& boxes, const Piece& piece);

}  // namespace caustics::beamtree

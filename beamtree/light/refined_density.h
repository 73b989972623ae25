#pragma once

#include <optional>

#include "beamtree/beams/beam.h"
#include "beamtree/light/beam_point.h"

namespace caustics::beamtree {

/// Of the light of the beam that a hit has found: its share for an area [m^-2] at the point, on the
/// plane of the hit, to second order (`intensity: refined`). The spreads of the corners' rays, taken as linear
/// between them, tell how the irradiance runs within a caustic polygon, and the flux of a pair of
/// triangles how large it is: the two halves of a parallelogram err by opposite first orders. Of a cell
/// it is the mean over the part that the hit covers: a polygon within the cell brings all of its flux. Where
/// the light goes down unevenly the plane is the one across the light that arrives.
///
/// Empty where [CC95 (11)] has to do: without spreads, within a fold, where the corners' spreads
/// differ by a factor of four (asked at a point: on the plane across the light as well), and where the plane
/// clips the polygon.
std::optional<double> refined_density(const BeamSet& set, const BeamHit& hit, const Vec3& point);

}  // namespace caustics::beamtree

#pragma once

#include "beamtree/light/beam_point.h"
#include "beamtree/slices/slice_frame.h"

namespace caustics::beamtree {

/// Squares on the planes of a frame, along its axes: where irradiance is averaged instead of being
/// asked at a point (`footprint`).
struct BeamSquare {
    const SliceFrame& frame;
    double half;  ///< of a side [m]
};

/// The part of a beam's caustic polygon that lies on the square round the plane's point. Appends a hit
/// for each of the beam's triangles that has one, with the share of the square it covers, and the
/// middle of that part as the place where the light left. Polygons that the plane cuts, and those
/// that run towards the horizon, are asked at the point as in find_in_beam.
/// `rays` are the beam's or copies of them (test_beam).
void find_on_square(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                    const BeamNumber& number, const TestPlane& plane, const BeamSquare& square,
                    std::vector<BeamHit>& hits, SearchCounts& counts);

}  // namespace caustics::beamtree

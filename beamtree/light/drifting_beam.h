#pragma once

#include <vector>

#include "beamtree/light/beam_point.h"

namespace caustics::beamtree {

/// The wavelengths for which a beam that drifts holds the point that the plane goes through. A corner of a
/// caustic polygon moves over the plane nearly linearly with the place in the bin (BeamSet::ends), so that the
/// point passes from one side of an edge to the other at the roots of a quadratic. Appends a hit for each
/// interval between them in which the polygon holds it, parted where the polygon's area changes. Edges that
/// two polygons share have the same roots, whatever the rounding. Where the plane cuts the polygon or its
/// light is uneven, the bin is divided into narrow intervals, each asked at its middle.
void find_in_drifting_beam(const BeamSet& set, const BeamNumber& number, const TestPlane& plane,
                           std::vector<BeamHit>& hits);

}  // namespace caustics::beamtree

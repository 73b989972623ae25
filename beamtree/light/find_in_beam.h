#pragma once

#include <array>
#include <vector>

#include "beamtree/light/beam_point.h"

namespace caustics::beamtree {

/// test_beam for the beam `number` of `set`, or find_in_drifting_beam where it drifts: counts the test, and
/// appends its hits with that number.
void find_in_beam(const BeamSet& set, const BeamNumber& number, const TestPlane& plane,
                  std::vector<BeamHit>& hits, SearchCounts& counts);
/// The same of a beam that does not drift, by copies of its rays (test_beam). Where the set has roots, all triangles of
/// the beam are appended, and hits are counted later, by the roots that are found.
void find_in_beam(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                  const BeamNumber& number, const TestPlane& plane, std::vector<BeamHit>& hits,
                  SearchCounts& counts);

}  // namespace caustics::beamtree

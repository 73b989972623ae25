#include "beamtree/light/find_in_beam.h"

#include <array>

#include "beamtree/light/drifting_beam.h"

namespace caustics::beamtree {

void find_in_beam(const BeamSet& set, const BeamNumber& number, const TestPlane& plane,
                  std::vector<BeamHit>& hits, SearchCounts& counts) {
    const std::size_t before = hits.size();
    if (set.drifts()) {
        find_in_drifting_beam(set, number, plane, hits);
    } else {
        std::array<BeamHit, 2> found;
        const int count = test_beam(set, set.beams[number.beam], plane, found);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            found[i].set = number.set;
            found[i].beam = number.beam;
            hits.push_back(found[i]);
        }
    }
    ++counts.beam_point_tests;
    counts.beam_point_hits += hits.size() > before ? 1 : 0;
}

}  // namespace caustics::beamtree

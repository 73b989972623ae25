#include "beamtree/light/find_in_beam.h"

#include <array>

#include "beamtree/light/drifting_beam.h"
#include "beamtree/light/image_model.h"

namespace caustics::beamtree {
namespace {

// Roots are searched in the image's surroundings: what the straight-sided image says serves where none is found.
void find_roots_in_beam(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                        const BeamNumber& number, const TestPlane& plane,
                        std::vector<BeamHit>& hits) {
    const Beam& beam = set.beams[number.beam];
    for (std::size_t i = 0; i < beam.triangle_count(); ++i) {
        const std::array<const VertexRay*, 3> corners = {rays[0], rays[1 + i], rays[2 + i]};
        const bool has_roots = set.has_roots(number.beam, i);
        if (test_triangle(corners, i, plane, hits)) {
            hits.back().flux_share *= beam.share_of(i);
        } else if (!has_roots ||
                   !may_have_image(plane.point().cast<float>(), corners,
                                   set.middles_of(number.beam, i), beam.has_dark_part)) {
            continue;
        } else {
            hits.emplace_back().winding = 0;
            hits.back().triangle = static_cast<std::uint8_t>(i);
        }
        hits.back().has_roots = has_roots;
        hits.back().set = number.set;
        hits.back().beam = number.beam;
    }
}

}  // namespace

void find_in_beam(const BeamSet& set, const BeamNumber& number, const TestPlane& plane,
                  std::vector<BeamHit>& hits, SearchCounts& counts) {
    if (!set.drifts()) {
        std::array<const VertexRay*, 4> rays = {};
        const Beam& beam = set.beams[number.beam];
        for (std::size_t i = 0; i < 4; ++i)
            if (beam.corners[i] != Beam::none) rays[i] = &set.rays[beam.corners[i]];
        find_in_beam(set, rays, number, plane, hits, counts);
        return;
    }
    const std::size_t before = hits.size();
    find_in_drifting_beam(set, number, plane, hits);
    ++counts.beam_point_tests;
    counts.beam_point_hits += hits.size() > before ? 1 : 0;
}

void find_in_beam(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                  const BeamNumber& number, const TestPlane& plane, std::vector<BeamHit>& hits,
                  SearchCounts& counts) {
    if (set.has_roots()) {
        find_roots_in_beam(set, rays, number, plane, hits);
        ++counts.beam_point_tests;
        return;
    }
    const int count = test_beam(rays, set.beams[number.beam], plane, hits);
    for (int i = 1; i <= count; ++i) {
        hits.end()[-i].set = number.set;
        hits.end()[-i].beam = number.beam;
    }
    ++counts.beam_point_tests;
    counts.beam_point_hits += count > 0 ? 1 : 0;
}

}  // namespace caustics::beamtree

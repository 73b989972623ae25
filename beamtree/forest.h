#pragma once

#include <span>
#include <vector>

#include "beamtree/beam_estimator.h"
#include "beamtree/beam_tree_params.h"
#include "beamtree/cones/cone_tree.h"
#include "beamtree/slices/slice_tree.h"
#include "beamtree/tracing/traced_scene.h"

namespace caustics::beamtree {

/// The trees that find a scene's beams. Each beam is in one of them: cone trees have the beams of
/// one light sample, caster and event; trees of slices those of all that share the normal of the
/// test planes (those over a mesh's quadtree: of one set as well). Beams that spread too far for
/// any fixed plane are in a cone tree of swept spheres, tested on the receiver's planes.
class Forest {
public:
    Forest(const Scene& scene, const TracedScene& traced, const BeamTreeParams& params,
           const RunOptions& options);

    /// Appends the hits at each point; `sets` are those of the traced scene.
    void find(std::span<const BeamSet> sets, std::span<const ReceiverPoint> points,
              BeamSearch& search) const;
    /// Adds trees, nodes, height, and how many trees have which hierarchy.
    void add_to(BuildReport& report) const;

private:
    std::vector<ConeTree> cones_;
    std::vector<SliceTree> slices_;
    std::uint64_t binned_ = 0;  ///< trees over `binned`
};

}  // namespace caustics::beamtree

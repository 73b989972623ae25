#pragma once

#include <vector>

#include "beamtree/tracing/beam_path.h"

namespace caustics {

/// Whether a piece of a flat first surface is too large for what its light meets: a pane of two
/// triangles shines on a ball that turns away within a hundredth of them. (Curved surfaces are as fine
/// as their mesh.)
class PieceDetail {
public:
    explicit PieceDetail(const Scene& scene);

    static bool is_flat(const RayOrigin& a, const RayOrigin& b);
    /// Whether two rays from a flat surface meet one that turns so much from one to the other that a
    /// beam between them is coarse.
    static bool is_coarse(const RayOrigin& from, const RayArrival& a, const RayOrigin& other,
                          const RayArrival& b);
    /// Whether there is a caster that the three rays may go round: it is small against the way from
    /// one to the other, and about where their light goes.
    bool may_pass_round_caster(const std::array<const VertexRay*, 3>& rays) const;

private:
    std::vector<Box> casters_;
    float far_;  ///< [m]
};

}  // namespace caustics

#pragma once

#include <span>
#include <vector>

#include "beamtree/beam.h"
#include "beamtree/beam_point.h"
#include "core/caustic_estimator.h"

namespace caustics {

/// What beams bring to a receiver point that lies inside them (row B8): each the irradiance
/// flux / area of its caustic polygon [CC95 eq. 11], whose flux is exact because it is counted by the
/// solid angle of the specular polygon. The cosine at the receiver is part of it. What stands
/// between the point and the place where the light was bent, or between that place and the light,
/// is asked of the scene.
class BeamLight {
public:
    BeamLight(const Scene& scene, const std::vector<BeamSet>& sets) : scene_(scene), sets_(sets) {}

    /// [W m^-2] on the side of the geometric normal. Sorts the hits: sums do not depend on the order
    /// in which they were found.
    Spectrum irradiance(const ReceiverPoint& point, std::vector<BeamHit>& hits) const;
    /// [W m^-2 sr^-1] leaving along the point's `wo`; every beam arrives along its own direction.
    Spectrum radiance(const ReceiverPoint& point, std::vector<BeamHit>& hits) const;

private:
    template <typename Weight>
    Spectrum sum(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                 const Weight& weight) const;

    const Scene& scene_;
    const std::vector<BeamSet>& sets_;
};

}  // namespace caustics

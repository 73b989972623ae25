#pragma once

#include <optional>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/light/beam_point.h"
#include "beamtree/light/specular_point.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// What beams bring to a receiver point that lies inside them (row B8): each the irradiance
/// flux / area of its caustic polygon [CC95 (11)], whose flux is exact because it is counted by the
/// solid angle of the specular polygon. Sets with spreads (`intensity: refined`) that exact shapes have
/// bent once are found at the specular point itself where there is one nearby, all others by refined_density.
/// The cosine at the receiver is part of it. What stands between the point and the place where the light
/// was bent, or between that place and the light, is asked of the scene.
class BeamLight {
public:
    /// Scene and sets outlive this.
    BeamLight(const Scene& scene, const std::vector<BeamSet>& sets);

    /// [W m^-2] on the side of the geometric normal. Sorts the hits: sums do not depend on the order
    /// in which they were found.
    Spectrum irradiance(const ReceiverPoint& point, std::vector<BeamHit>& hits) const;
    /// [W m^-2 sr^-1] leaving along the point's `wo`; every beam arrives along its own direction.
    Spectrum radiance(const ReceiverPoint& point, std::vector<BeamHit>& hits) const;

private:
    std::optional<SpecularPoint> specular_point(const BeamHit& hit, const VertexRay& guess,
                                                const Vec3& point) const;
    template <typename Weight>
    Spectrum sum(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                 const Weight& weight) const;

    const Scene& scene_;
    const std::vector<BeamSet>& sets_;
    std::vector<std::optional<SpecularSearch>>
        searches_;  ///< one a set; none where it cannot serve
};

}  // namespace caustics::beamtree

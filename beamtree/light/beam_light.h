#pragma once

#include <optional>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/light/beam_point.h"
#include "beamtree/light/root_search.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// A thread's scratch for roots, and what was found.
struct RootScratch {
    std::vector<Root> roots;    ///< of one triangle
    std::vector<Root> on_edge;  ///< of the triangles of one set before it
    std::uint64_t found = 0;
    std::uint64_t unsettled =
        0;  ///< triangles whose image holds the point, without a root: eq. 11 served
};

/// What beams bring to a receiver point (row B8): of sets that have roots (`intensity: refined`, at points) the light of
/// each ray that reaches it; of all others, each the irradiance flux / area of its caustic polygon [CC95 (11)], whose
/// flux is exact because it is counted by the solid angle of the specular polygon, or refined_density.
/// The cosine at the receiver is part of it. What stands between the point and the place where the light
/// was bent, or between that place and the light, is asked of the scene.
class BeamLight {
public:
    /// Scene and sets outlive this.
    BeamLight(const Scene& scene, const std::vector<BeamSet>& sets);

    /// [W m^-2] on the side of the geometric normal. Sorts the hits: sums do not depend on the order
    /// in which they were found.
    Spectrum irradiance(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                        RootScratch& scratch) const;
    /// [W m^-2 sr^-1] leaving along the point's `wo`; every beam arrives along its own direction.
    Spectrum radiance(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                      RootScratch& scratch) const;

    /// True where any set has roots: rays that reach a point are then searched for one by one.
    bool searches_roots() const;
    /// How a ray that arrives at the point in that unit direction is counted.
    RayCount count(const ReceiverPoint& point, const Vec3& direction, std::vector<BeamHit>& hits,
                   RootScratch& scratch) const;

private:
    /// Calls of_root(hit, root, share of its wavelengths) or of_polygon(hit, share) for all light of the point.
    template <typename OfRoot, typename OfPolygon>
    void visit(const ReceiverPoint& point, std::vector<BeamHit>& hits, RootScratch& scratch,
               const OfRoot& of_root, const OfPolygon& of_polygon) const;
    template <typename Weight>
    SpectrumSum of_polygon(const ReceiverPoint& point, const BeamHit& hit, const Spectrum& share,
                           const Weight& weight) const;
    template <typename Weight>
    SpectrumSum of_root(const ReceiverPoint& point, const BeamHit& hit, const Root& root,
                        const Spectrum& share, const Weight& weight) const;
    template <typename Weight>
    Spectrum sum(const ReceiverPoint& point, std::vector<BeamHit>& hits, RootScratch& scratch,
                 const Weight& weight) const;

    const Scene& scene_;
    const std::vector<BeamSet>& sets_;
    std::vector<std::optional<RootSearch>> searches_;  ///< one a set that has roots
};

}  // namespace caustics::beamtree

#pragma once

#include <vector>

#include "beamtree/light/beam_light.h"
#include "beamtree/pencils/pencil_map.h"
#include "beamtree/rest/photon_discs.h"
#include "beamtree/tracing/traced_scene.h"

namespace caustics::beamtree {

/// A thread's scratch and counters of a method that works with beams.
class BeamSearch : public QueryContext {
public:
    void add_to(Counters& counters) const override;

    std::vector<std::vector<BeamHit>> hits;  ///< of each point that is asked about
    std::vector<std::uint32_t> stack;
    std::vector<std::uint32_t> disc_stack;
    SearchCounts counts;
    RootScratch roots;
};

/// What `beamtree` and `causticpolygons` share: the beams of a scene, and the light that those
/// which hold a point bring to it. A method says how it finds them.
class BeamEstimator : public CausticEstimator {
public:
    std::unique_ptr<QueryContext> make_context() const override;
    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const final;
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const final;
    std::optional<std::vector<RayCount>> count_rays(std::span<const ArrivingLight> rays,
                                                    QueryContext& context) const final;
    /// Of the beams; methods add their own.
    BuildReport build_report() const override { return report_; }

protected:
    /// Keeps the beams, and the photons that complete their light, each with a disc that reaches to so many others;
    /// the casters' meshes are needed no more.
    BeamEstimator(const Scene& scene, TracedScene traced, std::uint32_t rest_nearest = 0,
                  int threads = 1, PencilMap pencils = {});

    const std::vector<BeamSet>& sets() const { return sets_; }

private:
    /// Appends the beams that hold each point to its list of `search.hits`; `search` is of the kind
    /// that the method's make_context() makes.
    virtual void find(std::span<const ReceiverPoint> points, BeamSearch& search) const = 0;
    /// The square round a point that it stands for, where the method has squares of its own.
    virtual std::optional<PixelCell> square(const ReceiverPoint&) const { return {}; }

    using Query = Spectrum (BeamLight::*)(const ReceiverPoint&, std::vector<BeamHit>&,
                                          RootScratch&) const;
    using RestQuery = Spectrum (PhotonDiscs::*)(const ReceiverPoint&,
                                                std::vector<std::uint32_t>&) const;
    using PencilQuery = Spectrum (PencilMap::*)(const ReceiverPoint&,
                                                std::vector<std::uint32_t>&) const;
    void answer(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                QueryContext& context, Query query, RestQuery of_rest,
                PencilQuery of_pencils) const;

    /// Finds the beams that hold each of these points, and calls take(index, hits).
    template <typename Take>
    void for_each_point(std::span<const ReceiverPoint> points, BeamSearch& search,
                        const Take& take) const;

    BuildReport report_;
    std::vector<BeamSet> sets_;
    BeamLight light_;
    PhotonDiscs rest_;
    PencilMap pencils_;
};

}  // namespace caustics::beamtree

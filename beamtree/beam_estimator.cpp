#include "beamtree/beam_estimator.h"

#include <algorithm>

namespace caustics::beamtree {

void BeamSearch::add_to(Counters& counters) const {
    counters["beam_point_tests"] += counts.beam_point_tests;
    counters["beam_point_hits"] += counts.beam_point_hits + roots.found;
    counters["roots_unsettled"] += roots.unsettled;
}

BeamEstimator::BeamEstimator(const Scene& scene, TracedScene traced, std::uint32_t rest_nearest,
                             int threads)
    : report_(traced.report()),
      sets_(std::move(traced.sets)),
      light_(scene, sets_),
      rest_(std::move(traced.rest), rest_nearest, threads) {
    report_.bytes += rest_.bytes();
}

std::unique_ptr<QueryContext> BeamEstimator::make_context() const {
    return std::make_unique<BeamSearch>();
}

void BeamEstimator::radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                             QueryContext& context) const {
    answer(points, out, context, &BeamLight::radiance, &PhotonDiscs::radiance);
}

void BeamEstimator::irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                               QueryContext& context) const {
    answer(points, out, context, &BeamLight::irradiance, &PhotonDiscs::irradiance);
}

void BeamEstimator::answer(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                           QueryContext& context, Query query, RestQuery of_rest) const {
    auto& search = dynamic_cast<BeamSearch&>(context);
    constexpr std::size_t together = 64;
    search.hits.resize(together);
    for (std::size_t first = 0; first < points.size(); first += together) {
        const std::size_t count = std::min(together, points.size() - first);
        for (std::vector<BeamHit>& hits : search.hits) hits.clear();
        find(points.subspan(first, count), search);
        for (std::size_t i = 0; i < count; ++i) {
            const ReceiverPoint& point = points[first + i];
            out[first + i] = {(light_.*query)(point, search.hits[i], search.roots), black()};
            if (!rest_.is_empty())
                out[first + i].value += (rest_.*of_rest)(point, search.disc_stack);
        }
    }
}

}  // namespace caustics::beamtree

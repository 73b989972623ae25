#include "beamtree/beam_estimator.h"

#include <algorithm>

namespace caustics::beamtree {

void BeamSearch::add_to(Counters& counters) const {
    counters["beam_point_tests"] += counts.beam_point_tests;
    counters["beam_point_hits"] += counts.beam_point_hits;
}

BeamEstimator::BeamEstimator(const Scene& scene, TracedScene traced)
    : report_(traced.report()), sets_(std::move(traced.sets)), light_(scene, sets_) {}

std::unique_ptr<QueryContext> BeamEstimator::make_context() const {
    return std::make_unique<BeamSearch>();
}

void BeamEstimator::radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                             QueryContext& context) const {
    answer(points, out, context, &BeamLight::radiance);
}

void BeamEstimator::irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                               QueryContext& context) const {
    answer(points, out, context, &BeamLight::irradiance);
}

void BeamEstimator::answer(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                           QueryContext& context, Query query) const {
    auto& search = dynamic_cast<BeamSearch&>(context);
    constexpr std::size_t together = 64;
    search.hits.resize(together);
    for (std::size_t first = 0; first < points.size(); first += together) {
        const std::size_t count = std::min(together, points.size() - first);
        for (std::vector<BeamHit>& hits : search.hits) hits.clear();
        find(points.subspan(first, count), search);
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = {(light_.*query)(points[first + i], search.hits[i]), black()};
    }
}

}  // namespace caustics::beamtree

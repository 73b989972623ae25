#include "beamtree/beam_estimator.h"

#include <algorithm>

namespace caustics::beamtree {

void BeamSearch::add_to(Counters& counters) const {
    counters["beam_point_tests"] += counts.beam_point_tests;
    counters["beam_point_hits"] += counts.beam_point_hits + roots.found;
    counters["roots_unsettled"] += roots.unsettled;
}

BeamEstimator::BeamEstimator(const Scene& scene, TracedScene traced, std::uint32_t rest_nearest,
                             int threads, PencilMap pencils)
    : report_(traced.report()),
      sets_(std::move(traced.sets)),
      light_(scene, sets_),
      rest_(std::move(traced.rest), rest_nearest, threads),
      pencils_(std::move(pencils)) {
    report_.bytes += rest_.bytes() + pencils_.bytes();
}

std::unique_ptr<QueryContext> BeamEstimator::make_context() const {
    return std::make_unique<BeamSearch>();
}

void BeamEstimator::radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                             QueryContext& context) const {
    answer(points, out, context, &BeamLight::radiance, &PhotonDiscs::radiance,
           &PencilMap::radiance);
}

void BeamEstimator::irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                               QueryContext& context) const {
    answer(points, out, context, &BeamLight::irradiance, &PhotonDiscs::irradiance,
           &PencilMap::irradiance);
}

template <typename Take>
void BeamEstimator::for_each_point(std::span<const ReceiverPoint> points, BeamSearch& search,
                                   const Take& take) const {
    constexpr std::size_t together = 64;
    search.hits.resize(together);
    for (std::size_t first = 0; first < points.size(); first += together) {
        const std::size_t count = std::min(together, points.size() - first);
        for (std::vector<BeamHit>& hits : search.hits) hits.clear();
        find(points.subspan(first, count), search);
        for (std::size_t i = 0; i < count; ++i) take(first + i, search.hits[i]);
    }
}

void BeamEstimator::answer(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                           QueryContext& context, Query query, RestQuery of_rest,
                           PencilQuery of_pencils) const {
    auto& search = dynamic_cast<BeamSearch&>(context);
    for_each_point(points, search, [&](std::size_t i, std::vector<BeamHit>& hits) {
        out[i] = {(light_.*query)(points[i], hits, search.roots), black()};
        if (!rest_.is_empty()) out[i].value += (rest_.*of_rest)(points[i], search.disc_stack);
        if (pencils_.is_empty()) return;
        ReceiverPoint point = points[i];
        const std::optional<PixelCell> own = square(point);
        if (own) point.cell = &*own;
        out[i].value += (pencils_.*of_pencils)(point, search.disc_stack);
    });
}

std::optional<std::vector<RayCount>> BeamEstimator::count_rays(std::span<const ArrivingLight> rays,
                                                               QueryContext& context) const {
    // Pencils search for no ray.
    if (!light_.searches_roots() || !pencils_.is_empty()) return {};
    auto& search = dynamic_cast<BeamSearch&>(context);
    std::vector<ReceiverPoint> points;
    for (const ArrivingLight& ray : rays) points.push_back(ray.point);
    std::vector<RayCount> counted(rays.size());
    for_each_point(points, search, [&](std::size_t i, std::vector<BeamHit>& hits) {
        counted[i] = light_.count(points[i], rays[i].direction, hits, search.roots);
    });
    return counted;
}

}  // namespace caustics::beamtree

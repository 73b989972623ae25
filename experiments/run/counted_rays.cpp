#include "experiments/run/counted_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/parallel.h"
#include "core/light_path/aimed_emission.h"
#include "core/reference/ordered_paths.h"

namespace caustics::experiments {

namespace {

/// Enough to tell 2 % by a third of itself.
constexpr std::size_t most_rays = 512;
constexpr std::uint64_t most_chunks = 64;
constexpr std::size_t rays_per_batch = 16;

ArrivingLight arriving(const Deposit& deposit) {
    ArrivingLight light;
    light.point.position = deposit.position;
    light.point.geometric_normal = deposit.geometric_normal;
    light.point.shading_normal = deposit.shading_normal;
    light.point.wo = deposit.wi;
    light.point.uv = deposit.uv;
    light.point.offset = deposit.offset;
    light.point.shape = deposit.shape;
    light.point.front = deposit.front;
    light.direction = -deposit.wi;
    light.watts = static_cast<double>(deposit.flux.mean());
    return light;
}

std::vector<ArrivingLight> some_rays(const Scene& scene, int max_bounces) {
    std::vector<ArrivingLight> rays;
    const AimedEmission emission(scene);
    if (emission.empty()) return rays;
    const OrderedPaths paths{scene,       emission, most_chunks * OrderedPaths::chunk,
                             max_bounces, 1,        Stage::survey};
    LightPathCounts counts;
    for (std::uint64_t chunk = 0; chunk < most_chunks && rays.size() < most_rays; ++chunk)
        paths.trace_chunk(chunk, counts, [&](const Deposit& deposit, std::uint64_t) {
            if (rays.size() < most_rays && deposit.flux.mean() > 0)
                rays.push_back(arriving(deposit));
        });
    return rays;
}

CountedRays::Share share_of(RayCount which, const std::vector<ArrivingLight>& rays,
                            const std::vector<RayCount>& counts) {
    double all = 0;
    double part = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        all += rays[i].watts;
        if (counts[i] == which) part += rays[i].watts;
    }
    const double share = part / all;
    double squares = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double off = ((counts[i] == which ? 1 : 0) - share) * rays[i].watts;
        squares += off * off;
    }
    return {share, std::sqrt(squares) / all};
}

bool is_told(double share, double error) {
    return share >= least_share_of_note && share >= 2 * error;
}

}  // namespace

std::optional<CountedRays> counted_rays(const Scene& scene, const CausticEstimator& built,
                                        int max_bounces, int threads) {
    if (!built.count_rays({}, *built.make_context())) return {};
    const std::vector<ArrivingLight> rays = some_rays(scene, max_bounces);
    if (rays.empty()) return {};
    std::vector<RayCount> counts(rays.size());
    const std::size_t batches = (rays.size() + rays_per_batch - 1) / rays_per_batch;
    std::vector<std::unique_ptr<QueryContext>> contexts;
    for (int i = 0; i < threads; ++i) contexts.push_back(built.make_context());
    parallel_for(threads, batches, [&](std::size_t batch, std::size_t worker) {
        const std::size_t first = batch * rays_per_batch;
        const std::size_t count = std::min(rays_per_batch, rays.size() - first);
        const auto answers =
            built.count_rays(std::span(rays).subspan(first, count), *contexts[worker]);
        std::ranges::copy(*answers, counts.begin() + static_cast<std::ptrdiff_t>(first));
    });
    return CountedRays{share_of(RayCount::missed, rays, counts),
                       share_of(RayCount::spread, rays, counts), rays.size()};
}

std::vector<std::string> notes_on(const CountedRays& rays, const CausticLedger& ledger) {
    std::vector<std::string> all;
    const double missed = rays.missed.value - ledger.share(ledger.missed_by_pruning);
    if (is_told(missed, rays.missed.error))
        all.push_back(fmt::format(
            "{:.1f} +- {:.1f} % of the light that arrives on receivers is not found at points, as "
            "{} "
            "light paths tell (a larger mesh_resolution finds more of it, photonmap has all of it)",
            100 * missed, 100 * rays.missed.error, rays.asked));
    if (is_told(rays.spread.value, rays.spread.error))
        all.push_back(fmt::format(
            "{:.1f} +- {:.1f} % of the light that arrives on receivers is spread over images of "
            "polygons at points, not found ray by ray, as {} light paths tell: its sum is right, "
            "its "
            "place is as coarse as the polygons (a larger root_events finds the rays of more "
            "events "
            "and takes longer)",
            100 * rays.spread.value, 100 * rays.spread.error, rays.asked));
    return all;
}

}  // namespace caustics::experiments

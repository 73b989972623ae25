#include "beamtree/tracing/beam_tracing.h"

#include <algorithm>
#include <numeric>

#include "beamtree/tracing/expected_least.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

// Casters with so many triangles are traced one after the other, each on all threads; so are few of them.
constexpr std::size_t large = 2048;
constexpr std::size_t few = 8;

// Of all casters and lights, were nothing between them [W].
double first_flux(const Scene& scene, const std::vector<CasterMesh>& casters,
                  const std::vector<LightSample>& lights, int threads) {
    double sum = 0;
    for (const LightSample& light : lights)
        for (const CasterMesh& caster : casters) sum += first_flux(scene, caster, light, threads);
    return sum;
}

// One light and caster may need more than its even share, but all together are not counted much more often than
// there are beams in the end.
BeamBudget part_of_budget(std::uint64_t most, std::size_t parts, double least) {
    return BeamBudget(parts <= 2 ? most : std::max<std::uint64_t>(1, 2 * (most / parts)), least);
}

// Where beams are too many: the parts that have some that do not fit, with budgets of those that do.
std::vector<std::size_t> fit_to_budget(std::vector<BeamBudget>& budgets, std::uint64_t most) {
    BeamBudget all(most);
    for (const BeamBudget& budget : budgets) all.add(budget);
    std::vector<std::size_t> again;
    for (std::size_t i = 0; i < budgets.size(); ++i) {
        if (!budgets[i].is_over() && budgets[i].all_have(all.least())) continue;
        budgets[i] = BeamBudget(BeamBudget::no_limit, std::max(all.least(), budgets[i].least()));
        again.push_back(i);
    }
    return again;
}

}  // namespace

TracedBeams trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                            const std::vector<LightSample>& lights, const TraceSettings& settings,
                            const RunOptions& options) {
    std::vector<MeshNeighbours> neighbours;
    if (settings.intensity == Intensity::refined)
        for (const CasterMesh& caster : casters) neighbours.emplace_back(caster, options.threads);
    const bool asks_boxes = settings.max_bounces > 1 || settings.receiver_margin;
    const SceneBoxes boxes = asks_boxes ? scene_boxes(scene) : SceneBoxes{};
    std::vector<TracedBeams> parts(lights.size() * casters.size());
    const double least = expected_least(scene, boxes, casters, lights, settings, options);
    TraceSettings of_all = settings;
    of_all.seed = options.seed;
    if (settings.rest_photons > 0)
        of_all.watts_per_photon = first_flux(scene, casters, lights, options.threads) /
                                  static_cast<double>(settings.rest_photons);
    std::vector<BeamBudget> budgets(parts.size(),
                                    part_of_budget(settings.max_beams, parts.size(), least));
    const auto trace = [&](const std::vector<std::size_t>& which) {
        TraceProgress progress(options);
        const ProgressPart one{progress, 1 / static_cast<double>(which.size())};
        const auto part = [&](std::size_t i, int threads) {
            const std::size_t caster = i % casters.size();
            TraceSettings own = of_all;
            own.threads = threads;
            own.least_divided =
                least_to_divide(settings, casters[caster].mesh.triangles.size(), parts.size());
            parts[i] = trace_beams(scene, boxes, casters[caster],
                                   neighbours.empty() ? nullptr : &neighbours[caster],
                                   lights[i / casters.size()], own, budgets[i], one);
        };
        std::vector<std::size_t> small;
        for (const std::size_t i : which) {
            const bool is_large = casters[i % casters.size()].mesh.triangles.size() >= large;
            if (is_large || which.size() < few)
                part(i, options.threads);
            else
                small.push_back(i);
        }
        parallel_for(options.threads, small.size(),
                     [&](std::size_t k, std::size_t) { part(small[k], 1); });
    };
    std::vector<std::size_t> every(parts.size());
    std::iota(every.begin(), every.end(), std::size_t{0});
    trace(every);
    trace(fit_to_budget(budgets, settings.max_beams));
    TracedBeams all;
    for (const BeamBudget& budget : budgets)
        all.least_light = std::max(all.least_light, budget.least());
    for (TracedBeams& part : parts) {
        all.balance.add(part.balance);
        all.drift.add(part.drift);
        all.unreceived += part.unreceived;
        all.rest.insert(all.rest.end(), part.rest.begin(), part.rest.end());
        for (BeamSet& set : part.sets)
            if (!set.beams.empty()) all.sets.push_back(std::move(set));
    }
    return all;
}

std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options) {
    return trace_all_beams(scene, casters, lights, TraceSettings{}, options).sets;
}

}  // namespace caustics::beamtree

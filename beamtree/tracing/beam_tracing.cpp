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

// Of nothing where nobody asks for them.
SceneBoxes boxes_for(const Scene& scene, const TraceSettings& settings) {
    return settings.max_bounces > 1 || settings.receiver_margin ? scene_boxes(scene) : SceneBoxes{};
}

TracedBeams joined(std::vector<TracedBeams>& parts, const std::vector<BeamBudget>& budgets) {
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

/// Each caster in each light, lights outermost: a part.
class Parts {
public:
    Parts(const Scene& scene, const std::vector<CasterMesh>& casters,
          const std::vector<LightSample>& lights, const TraceSettings& settings,
          const RunOptions& options)
        : scene_(scene),
          casters_(casters),
          lights_(lights),
          settings_(settings),
          options_(options),
          boxes_(boxes_for(scene, settings)),
          parts_(lights.size() * casters.size()) {
        if (settings.intensity == Intensity::refined)
            for (const CasterMesh& caster : casters)
                neighbours_.emplace_back(caster, options.threads);
        settings_.seed = options.seed;
        settings_.sampled_photons = (settings.sampled_photons + parts_.size() - 1) /
                                    std::max<std::size_t>(1, parts_.size());
        if (settings.rest.photons > 0)
            settings_.watts_per_photon = first_flux(scene, casters, lights, options.threads) /
                                         static_cast<double>(settings.rest.photons);
    }

    TracedBeams run() {
        const double least = expected_least(scene_, boxes_, casters_, lights_, settings_, options_);
        budgets_.assign(parts_.size(), part_of_budget(settings_.max_beams, parts_.size(), least));
        std::vector<std::size_t> every(parts_.size());
        std::iota(every.begin(), every.end(), std::size_t{0});
        trace(every);
        trace(fit_to_budget(budgets_, settings_.max_beams));
        return joined(parts_, budgets_);
    }

private:
    void trace(const std::vector<std::size_t>& which) {
        TraceProgress progress(options_);
        const ProgressPart one{progress, 1 / static_cast<double>(which.size())};
        std::vector<std::size_t> small;
        for (const std::size_t i : which) {
            const bool is_large = casters_[i % casters_.size()].mesh.triangles.size() >= large;
            if (is_large || which.size() < few)
                trace(i, options_.threads, one);
            else
                small.push_back(i);
        }
        parallel_for(options_.threads, small.size(),
                     [&](std::size_t k, std::size_t) { trace(small[k], 1, one); });
    }

    void trace(std::size_t i, int threads, const ProgressPart& progress) {
        const std::size_t caster = i % casters_.size();
        const CasterMesh& polygons = casters_[caster];
        TraceSettings own = settings_;
        own.threads = threads;
        own.least_divided =
            least_to_divide(settings_, polygons.mesh.triangles.size(), parts_.size());
        parts_[i] = trace_beams(scene_, boxes_, polygons,
                                neighbours_.empty() ? nullptr : &neighbours_[caster],
                                lights_[i / casters_.size()], own, budgets_[i], progress);
    }

    const Scene& scene_;
    const std::vector<CasterMesh>& casters_;
    const std::vector<LightSample>& lights_;
    TraceSettings settings_;
    const RunOptions& options_;
    SceneBoxes boxes_;
    std::vector<MeshNeighbours> neighbours_;
    std::vector<TracedBeams> parts_;
    std::vector<BeamBudget> budgets_;
};

}  // namespace

TracedBeams trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                            const std::vector<LightSample>& lights, const TraceSettings& settings,
                            const RunOptions& options) {
    return Parts(scene, casters, lights, settings, options).run();
}

std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options) {
    return trace_all_beams(scene, casters, lights, TraceSettings{}, options).sets;
}

}  // namespace caustics::beamtree

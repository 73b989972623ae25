#include "beamtree/tracing/expected_least.h"

#include <algorithm>
#include <atomic>

#include "beamtree/beams/caster_sample.h"
#include "core/base/parallel.h"
#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

// Polygons of one caster in one light that are traced together, and of all draws.
constexpr std::size_t together = 4;
constexpr double fewest_polygons = 64;
constexpr double most_polygons = 2'000;
// Beams of the sample by which the least is told.
constexpr double enough = 4'000;
// A little room, so that a sample that tells too little seldom makes all be traced again.
constexpr double filling = 0.9;
// From light to light that is tried, of the first events' mean.
constexpr double first_try = 0.1;
constexpr double step = 0.25;
constexpr double last_try = 1e-5;

/// Polygons drawn from all casters alike, each lot with its light.
class Draws {
public:
    Draws(const Scene& scene, const SceneBoxes& boxes, const std::vector<CasterMesh>& casters,
          const std::vector<LightSample>& lights, const RunOptions& options)
        : scene_(scene),
          boxes_(boxes),
          lights_(lights),
          threads_(options.threads),
          progress_(options) {
        for (const CasterMesh& caster : casters) {
            polygons_ += static_cast<double>(caster.mesh.triangles.size());
            up_to_.push_back(polygons_);
        }
        polygons_ *= static_cast<double>(lights.size());
    }

    /// Of all casters, once a light.
    double polygons() const { return polygons_; }

    void draw(const std::vector<CasterMesh>& casters, std::size_t count, Rng& rng) {
        for (std::size_t i = 0; i < count; i += together) {
            const double at = rng.next_fine() * up_to_.back();
            const auto caster = static_cast<std::size_t>(
                std::upper_bound(up_to_.begin(), up_to_.end(), at) - up_to_.begin());
            const auto light =
                static_cast<std::size_t>(rng.next_fine() * static_cast<double>(lights_.size()));
            const CasterMesh& from = casters[caster];
            CasterMesh drawn = draw_polygons(from.mesh, together, rng);
            drawn.shape = from.shape;
            drawn.tessellated = from.tessellated;
            drawn_.push_back({std::move(drawn), light, from.mesh.triangles.size()});
        }
    }

    /// Of the first events' beams on average [W].
    double mean_light() {
        struct Sum {
            double light = 0;
            double count = 0;
        };
        std::vector<Sum> sums(drawn_.size());
        parallel_chunks(threads_, drawn_.size(), 1, [&](const Chunk& chunk) {
            BeamBudget all;
            for (const BeamSet& set : trace(drawn_[chunk.index], {}, all).sets)
                for (const Beam& beam : set.beams) {
                    sums[chunk.index].light += static_cast<double>(beam.flux.mean());
                    ++sums[chunk.index].count;
                }
        });
        Sum all;
        for (const Sum& sum : sums) {
            all.light += sum.light;
            all.count += sum.count;
        }
        return all.count > 0 ? all.light / all.count : 0;
    }
    void count(const TraceSettings& settings, BeamBudget& budget) {
        std::vector<BeamBudget> counts(drawn_.size(),
                                       BeamBudget(BeamBudget::no_limit, budget.least()));
        parallel_chunks(threads_, drawn_.size(), 1, [&](const Chunk& chunk) {
            follow(drawn_[chunk.index], settings, counts[chunk.index]);
        });
        for (const BeamBudget& one : counts) budget.add(one);
    }
    /// Whether they have at most so many beams, however weak. Ends with the first that are too many.
    bool have_at_most(std::uint64_t most, const TraceSettings& settings) {
        std::atomic<std::uint64_t> counted{0};
        parallel_chunks(threads_, drawn_.size(), 1, [&](const Chunk& chunk) {
            if (counted > most) return;
            BeamBudget own(most);
            follow(drawn_[chunk.index], settings, own);
            counted += own.is_over() ? most + 1 : own.count();
        });
        return counted <= most;
    }

private:
    struct Lot {
        CasterMesh polygons;
        std::size_t light;
        std::size_t of_polygons;  ///< that the caster has
    };

    void follow(const Lot& lot, const TraceSettings& settings, BeamBudget& budget) {
        TraceSettings own = settings;
        own.least_divided =
            least_to_divide(settings, lot.of_polygons, up_to_.size() * lights_.size());
        trace(lot, own, budget);
    }
    TracedBeams trace(const Lot& lot, const TraceSettings& settings, BeamBudget& budget) {
        return trace_beams(scene_, boxes_, lot.polygons, nullptr, lights_[lot.light], settings,
                           budget, {progress_, 0});
    }

    const Scene& scene_;
    const SceneBoxes& boxes_;
    const std::vector<LightSample>& lights_;
    int threads_;
    TraceProgress progress_;
    std::vector<double> up_to_;  ///< polygons of a caster and those before it
    double polygons_ = 0;
    std::vector<Lot> drawn_;
};

double beams_of_polygon(double polygons, std::uint64_t max_beams) {
    return filling * static_cast<double>(max_beams) / polygons;
}

// The number of beams that drawn polygons have where those of all polygons are `max_beams`.
std::uint64_t most_of_draws(double polygons, std::uint64_t max_beams, std::size_t drawn) {
    return static_cast<std::uint64_t>(beams_of_polygon(polygons, max_beams) *
                                      static_cast<double>(drawn)) +
           1;
}

// Keeps the settings that matter for the number of beams.
TraceSettings alone(const TraceSettings& settings) {
    return {.max_bounces = settings.max_bounces,
            .prune = settings.prune,
            .least_divided = settings.least_divided,
            .divided_share = settings.divided_share};
}

}  // namespace

std::size_t draw_count(double polygons, std::uint64_t max_beams) {
    const double most = std::clamp(polygons, fewest_polygons, most_polygons);
    return static_cast<std::size_t>(
        std::clamp(enough / beams_of_polygon(polygons, max_beams), fewest_polygons, most));
}

bool beams_fit(const Scene& scene, const std::vector<CasterMesh>& casters,
               const std::vector<LightSample>& lights, const TraceSettings& settings,
               const RunOptions& options) {
    const SceneBoxes boxes = scene_boxes(scene);
    Draws draws(scene, boxes, casters, lights, options);
    if (draws.polygons() == 0) return true;
    const std::size_t count = draw_count(draws.polygons(), settings.max_beams);
    Rng rng(options.seed, Stage::beams, lights.size());
    draws.draw(casters, count, rng);
    return draws.have_at_most(most_of_draws(draws.polygons(), settings.max_beams, count),
                              alone(settings));
}

double expected_least(const Scene& scene, const SceneBoxes& boxes,
                      const std::vector<CasterMesh>& casters,
                      const std::vector<LightSample>& lights, const TraceSettings& settings,
                      const RunOptions& options) {
    Draws draws(scene, boxes, casters, lights, options);
    if (settings.max_bounces == 1 || settings.max_beams == BeamBudget::no_limit ||
        draws.polygons() == 0)
        return 0;
    const std::size_t count = draw_count(draws.polygons(), settings.max_beams);
    Rng rng(options.seed, Stage::beams, lights.size());
    draws.draw(casters, count, rng);
    const TraceSettings own = alone(settings);
    const std::uint64_t most = most_of_draws(draws.polygons(), settings.max_beams, count);
    if (draws.have_at_most(most, own)) return 0;
    const double mean = draws.mean_light();
    for (double share = first_try; share > last_try; share *= step) {
        BeamBudget budget(most, share * mean);
        draws.count(own, budget);
        if (budget.is_over()) return budget.least();
    }
    BeamBudget budget(most);
    draws.count(own, budget);
    return budget.least();
}

}  // namespace caustics::beamtree

#include "photonmap/global_photon_map.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/math/sampling.h"
#include "core/reference/backward_chain.h"
#include "photonmap/estimate/max_radius.h"
#include "photonmap/estimate/radiance_estimate.h"
#include "photonmap/gather/direction_histogram.h"
#include "photonmap/photons/global_photons.h"
#include "photonmap/tree/build_tree.h"

namespace caustics::photonmap {
namespace {

/// Of irradiance: pi times what it reflects.
const Bsdf white{Diffuse{Spectrum(Spectrum::Ones())}};

/// A thread's scratch and counters.
struct GlobalContext final : QueryContext {
    void add_to(Counters& counters) const override {
        counters["gathers"] += gathers;
        counters["gather_rays"] += rays;
        counters["gathered_photons"] += photons;
    }

    GatherScratch scratch;
    EstimateScratch estimate;
    std::vector<ReceiverPoint> ahead;  ///< where gather rays end
    std::vector<Spectrum> weights;
    std::uint64_t gathers = 0;
    std::uint64_t rays = 0;
    std::uint64_t photons = 0;
};

/// Photons in a tree, and the estimate over it.
struct Map {
    std::unique_ptr<const PhotonTree> tree;
    RadianceEstimate::Settings settings;
    RadianceEstimate estimate;

    Map(PhotonStore photons, const RadianceEstimate::Settings& how, Isa isa)
        : tree(build_tree(TreeKind::packed, std::move(photons), isa)),
          settings(how),
          estimate(how, isa) {}

    /// Calls take(i, gathered) for every point.
    template <typename Take>
    void gather(std::span<const ReceiverPoint> points, GlobalContext& context,
                const Take& take) const {
        tree->gather(points, settings.limits, context.scratch,
                     [&](std::size_t i, const GatheredPhotons& gathered) {
                         ++context.gathers;
                         context.photons += gathered.count;
                         take(i, gathered);
                     });
    }
};

class GlobalPhotonMap final : public IndirectEstimator {
public:
    GlobalPhotonMap(const Scene& scene, const GlobalMapParams& params, const RunOptions& options,
                    std::unique_ptr<const Map> all, std::unique_ptr<const Map> indirect,
                    BuildReport report)
        : scene_(scene),
          params_(params),
          seed_(options.seed),
          all_(std::move(all)),
          indirect_(std::move(indirect)),
          report_(std::move(report)) {}

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<GlobalContext>();
    }
    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const override {
        auto& own = dynamic_cast<GlobalContext&>(context);
        if (params_.gather == 0)
            show(points, out, own, &RadianceEstimate::radiance);
        else
            for (std::size_t i = 0; i < points.size(); ++i) out[i].value = gathered(points[i], own);
    }
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const override {
        auto& own = dynamic_cast<GlobalContext&>(context);
        if (params_.gather == 0) return show(points, out, own, &RadianceEstimate::irradiance);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ReceiverPoint point = points[i];
            point.bsdf = &white;
            point.shading_normal = point.wo = point.geometric_normal;
            out[i].value = pi * gathered(point, own);
        }
    }
    BuildReport build_report() const override { return report_; }

private:
    using Value = Spectrum (RadianceEstimate::*)(const ReceiverPoint&, const GatheredPhotons&,
                                                 EstimateScratch&) const;

    void show(std::span<const ReceiverPoint> points, std::span<Estimate> out,
              GlobalContext& context, Value value) const {
        indirect_->gather(points, context, [&](std::size_t i, const GatheredPhotons& photons) {
            out[i].value = (indirect_->estimate.*value)(points[i], photons, context.estimate);
        });
    }

    // Final gathering: the mean over M rays, spread evenly over the directions' chances.
    Spectrum gathered(const ReceiverPoint& point, GlobalContext& context) const {
        throw_if_interrupted();
        send_rays(point, context);
        SpectrumSum sum = SpectrumSum::Zero();
        all_->gather(context.ahead, context, [&](std::size_t i, const GatheredPhotons& photons) {
            const Spectrum light =
                all_->estimate.radiance(context.ahead[i], photons, context.estimate);
            context.weights[i] *= light;
        });
        for (const Spectrum& weight : context.weights) sum += weight.cast<double>();
        return (sum / params_.gather).cast<float>();
    }

    void send_rays(const ReceiverPoint& point, GlobalContext& context) const {
        context.ahead.clear();
        context.weights.clear();
        if (params_.diffuse_bounces == 1) return;
        std::optional<DirectionHistogram> directions;
        indirect_->gather({&point, 1}, context, [&](std::size_t, const GatheredPhotons& photons) {
            directions.emplace(point.geometric_normal, photons);
        });
        Rng rng(seed_, Stage::final_gather, point.id);
        const double turn = rng.next_fine();
        const double shift = rng.next_fine();
        for (int i = 0; i < params_.gather; ++i) {
            const auto sample =
                directions->sample((i + shift) / params_.gather,
                                   radical_inverse<2>(static_cast<std::uint64_t>(i), turn));
            const Spectrum f =
                evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, sample.direction);
            if (is_black(f)) continue;
            ++context.rays;
            BackwardChain chain{
                .ray = spawn_ray({point.position, point.geometric_normal, point.offset},
                                 sample.direction),
                .wavelength = {.nm = point.nm}};
            const auto ahead = receiver_ahead(scene_, chain, params_.max_bounces, rng);
            if (!ahead) continue;
            context.ahead.push_back(ahead->point);
            context.weights.push_back(f * ahead->weight * (pi * sample.weight));
        }
    }

    const Scene& scene_;
    GlobalMapParams params_;
    std::uint64_t seed_;
    std::unique_ptr<const Map> all_;  ///< none where the map itself is shown
    std::unique_ptr<const Map> indirect_;
    BuildReport report_;
};

}  // namespace

std::unique_ptr<const IndirectEstimator> build(const Scene& scene, const GlobalMapParams& params,
                                               const RunOptions& options) {
    options.phase("trace");
    GlobalMapParams traced = params;
    // The point that gathers is the last receiver itself.
    if (params.gather > 0 && params.diffuse_bounces > 1) --traced.diffuse_bounces;
    TracedPhotons photons = trace_global(scene, traced, options);
    RadianceEstimate::Settings settings;
    const double max_radius =
        params.max_radius > 0
            ? params.max_radius
            : default_max_radius(photons.store.photons(), scene.bounds(), params.nearest);
    settings.limits = {static_cast<std::size_t>(params.nearest), static_cast<float>(max_radius)};
    settings.flux_unit = photons.flux_per_energy();

    options.phase("balance");
    BuildReport report;
    photons.counts.add_to(report.counters);
    report.resolved["max_radius"] = max_radius;
    auto indirect =
        std::make_unique<const Map>(take_indirect(photons.store), settings, options.isa);
    std::unique_ptr<const Map> all;
    if (params.gather > 0)
        all = std::make_unique<const Map>(std::move(photons.store), settings, options.isa);
    report.counters["photons_from_diffuse"] = indirect->tree->size();
    report.bytes = indirect->tree->bytes() + (all ? all->tree->bytes() : 0);
    return std::make_unique<GlobalPhotonMap>(scene, params, options, std::move(all),
                                             std::move(indirect), std::move(report));
}

const DescribedMethod<GlobalMapParams, IndirectEstimator>& globalphotonmap_method() {
    using P = GlobalMapParams;
    static const DescribedMethod<P, IndirectEstimator> method(
        {.facts = {.name = "globalphotonmap",
                   .summary = "photons stored at every diffuse surface, seen by final gathering",
                   .serves = "every scene with light"},
         .parameters =
             {parameter::whole_number<P>(&P::photons, 1, 1'000'000'000,
                                         {.key = "photons",
                                          .meaning = "Photons to store, of all events.",
                                          .unit = "photons",
                                          .source = "[C11]"}),
              parameter::max_bounces<P>(), parameter::diffuse_bounces<P>(),
              parameter::whole_number<P>(&P::nearest, 2, 100'000,
                                         {.key = "nearest",
                                          .meaning = "N, the photons of an estimate.",
                                          .unit = "photons",
                                          .source = "[J96 (3)]"}),
              parameter::optional_length<P>(
                  &P::max_radius, "leave it out to have it chosen",
                  {.key = "max_radius", .meaning = "Farthest photon of an estimate."})
                  .usually("chosen"),
              parameter::whole_number<P>(
                  &P::gather, 0, 1'000'000,
                  {.key = "gather",
                   .meaning = "M rays of final gathering from each point; 0 shows the map itself.",
                   .unit = "rays",
                   .source = "[Jensen 1995]"})},
         .take_least_work = [](P& params) { params.photons = 1; }});
    return method;
}

}  // namespace caustics::photonmap

#include "photonmap/global_photon_map.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/math/sampling.h"
#include "core/reference/backward_chain.h"
#include "photonmap/estimate/max_radius.h"
#include "photonmap/gather/direction_histogram.h"
#include "photonmap/gather/irradiance_map.h"
#include "photonmap/photons/global_photons.h"
#include "photonmap/photons/photon_source.h"
#include "photonmap/shadow/shadow_map.h"

namespace caustics::photonmap {
namespace {

/// A thread's scratch and counters.
struct GlobalContext final : QueryContext {
    void add_to(Counters& counters) const override {
        counters["gathers"] += gathers;
        counters["gather_rays"] += rays;
        counters["gathered_photons"] += photons;
        if (params.gather > 0 && params.precompute > 0) counters["irradiance_lookups"] += lookups;
    }
    explicit GlobalContext(const GlobalMapParams& how) : params(how) {}

    /// Calls take(i, gathered) for every point.
    template <typename Take>
    void gather(const DensityMap& map, std::span<const ReceiverPoint> points, const Take& take) {
        map.gather(points, scratch, [&](std::size_t i, const GatheredPhotons& gathered) {
            ++gathers;
            photons += gathered.count;
            take(i, gathered);
        });
    }

    const GlobalMapParams& params;
    GatherScratch scratch;
    EstimateScratch estimate;
    // Where gather rays end: on surfaces whose irradiance is looked up, and on others.
    std::vector<ReceiverPoint> diffuse, others;
    std::vector<Spectrum> diffuse_weights, other_weights;
    std::uint64_t gathers = 0;
    std::uint64_t rays = 0;
    std::uint64_t photons = 0;
    std::uint64_t lookups = 0;
};

// Whether what it reflects is its irradiance times a factor. Under a normal that leans by an angle, (1 - cosine) / 2 of an
// even light comes from below the horizon of f_r: here 0.25 % at most.
bool reflects_by_irradiance(const ReceiverPoint& point) {
    return std::holds_alternative<Diffuse>(point.bsdf->model) &&
           point.shading_normal.dot(point.geometric_normal) > 0.995F;
}

/// The maps of all photons and of those from diffuse surfaces, and what is known beforehand of the first;
/// without final gathering the second alone.
struct GlobalMaps {
    std::unique_ptr<const DensityMap> all;
    std::unique_ptr<const IrradianceMap> irradiance;
    std::unique_ptr<const DensityMap> indirect;
    std::unique_ptr<const ShadowMap> shadows;

    std::uint64_t bytes() const {
        return indirect->bytes() + (all ? all->bytes() : 0) +
               (irradiance ? irradiance->bytes() : 0) + (shadows ? shadows->bytes() : 0);
    }
};

class GlobalPhotonMap final : public IndirectEstimator, private KnownShadows {
public:
    GlobalPhotonMap(const Scene& scene, const GlobalMapParams& params, const RunOptions& options,
                    GlobalMaps maps, BuildReport report)
        : scene_(scene),
          params_(params),
          seed_(options.seed),
          maps_(std::move(maps)),
          report_(std::move(report)) {}

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<GlobalContext>(params_);
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
        for (std::size_t i = 0; i < points.size(); ++i)
            out[i].value = pi * gathered(white_point(points[i]), own);
    }
    BuildReport build_report() const override { return report_; }
    const KnownShadows* known_shadows() const override { return maps_.shadows ? this : nullptr; }

private:
    Seen sees(const ReceiverPoint& point, std::size_t light, QueryContext& context) const override {
        return maps_.shadows->sees(point, light, dynamic_cast<GlobalContext&>(context).scratch);
    }

    using Value = Spectrum (RadianceEstimate::*)(const ReceiverPoint&, const GatheredPhotons&,
                                                 EstimateScratch&) const;

    void show(std::span<const ReceiverPoint> points, std::span<Estimate> out,
              GlobalContext& context, Value value) const {
        const DensityMap& map = *maps_.indirect;
        context.gather(map, points, [&](std::size_t i, const GatheredPhotons& photons) {
            out[i].value = (map.estimate().*value)(points[i], photons, context.estimate);
        });
    }

    // Final gathering: the mean over M rays, spread evenly over the directions' chances.
    Spectrum gathered(const ReceiverPoint& point, GlobalContext& context) const {
        throw_if_interrupted();
        send_rays(point, context);
        look_up(context);
        const DensityMap& all = *maps_.all;
        context.gather(all, context.others, [&](std::size_t i, const GatheredPhotons& photons) {
            context.other_weights[i] *=
                all.estimate().radiance(context.others[i], photons, context.estimate);
        });
        SpectrumSum sum = SpectrumSum::Zero();
        for (const Spectrum& light : context.diffuse_weights) sum += light.cast<double>();
        for (const Spectrum& light : context.other_weights) sum += light.cast<double>();
        return (sum / params_.gather).cast<float>();
    }

    // The light of ends whose irradiance is known; ends where it is not go to the others.
    void look_up(GlobalContext& context) const {
        if (!maps_.irradiance) return;
        maps_.irradiance->read(context.diffuse, context.scratch,
                               [&](std::size_t i, const std::optional<Spectrum>& irradiance) {
                                   ++context.lookups;
                                   Spectrum& weight = context.diffuse_weights[i];
                                   const ReceiverPoint& end = context.diffuse[i];
                                   if (irradiance) {
                                       weight *= *irradiance * evaluate(*end.bsdf, end.uv,
                                                                        end.shading_normal, end.wo,
                                                                        end.shading_normal);
                                   } else {
                                       context.others.push_back(end);
                                       context.other_weights.push_back(weight);
                                       weight = black();
                                   }
                               });
    }

    void send_rays(const ReceiverPoint& point, GlobalContext& context) const {
        context.diffuse.clear();
        context.others.clear();
        context.diffuse_weights.clear();
        context.other_weights.clear();
        if (params_.diffuse_bounces == 1) return;
        std::optional<DirectionHistogram> directions;
        context.gather(*maps_.indirect, {&point, 1},
                       [&](std::size_t, const GatheredPhotons& photons) {
                           directions.emplace(point.geometric_normal, photons);
                       });
        Rng rng(seed_, Stage::final_gather, point.id);
        const double turn = rng.next_fine();
        const double shift = rng.next_fine();
        for (int i = 0; i < params_.gather; ++i) {
            const auto sample =
                directions->sample((i + shift) / params_.gather,
                                   radical_inverse<2>(static_cast<std::uint64_t>(i), turn));
            send_ray(point, sample, rng, context);
        }
    }

    void send_ray(const ReceiverPoint& point, const DirectionHistogram::Sample& sample, Rng& rng,
                  GlobalContext& context) const {
        const Spectrum f =
            evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, sample.direction);
        if (is_black(f)) return;
        ++context.rays;
        BackwardChain chain{.ray = spawn_ray({point.position, point.geometric_normal, point.offset},
                                             sample.direction),
                            .wavelength = {.nm = point.nm},
                            .start_absorption = point.medium};
        const auto ahead =
            receiver_ahead(scene_, chain, scene_.intersect(chain.ray), params_.max_bounces, rng);
        if (!ahead) return;
        const bool known = maps_.irradiance && reflects_by_irradiance(ahead->point);
        (known ? context.diffuse : context.others).push_back(ahead->point);
        (known ? context.diffuse_weights : context.other_weights)
            .push_back(f * ahead->weight * (pi * sample.weight));
    }

    const Scene& scene_;
    GlobalMapParams params_;
    std::uint64_t seed_;
    GlobalMaps maps_;
    BuildReport report_;
};

GlobalMaps order(PhotonStore photons, const GlobalMapParams& params,
                 const RadianceEstimate::Settings& settings, const RunOptions& options) {
    options.phase("balance");
    GlobalMaps maps;
    maps.indirect =
        std::make_unique<const DensityMap>(take_indirect(photons), settings, options.isa);
    if (params.gather == 0) return maps;
    std::optional<PhotonStore> places;
    if (params.precompute > 0) places = every_kth(photons.photons(), params.precompute);
    maps.all = std::make_unique<const DensityMap>(std::move(photons), settings, options.isa);
    if (!places) return maps;
    options.phase("precompute");
    maps.irradiance = std::make_unique<const IrradianceMap>(std::move(*places), *maps.all, options);
    return maps;
}

}  // namespace

std::unique_ptr<const IndirectEstimator> build(const Scene& scene, const GlobalMapParams& params,
                                               const RunOptions& options) {
    GlobalMapParams traced = params;
    // The point that gathers is the last receiver itself.
    if (params.gather > 0 && params.diffuse_bounces > 1) --traced.diffuse_bounces;
    SavedPhotons kept = photon_source(scene, traced, options);
    TracedPhotons& photons = kept.photons;
    RadianceEstimate::Settings settings;
    const double max_radius =
        params.max_radius > 0
            ? params.max_radius
            : default_max_radius(photons.store.photons(), scene.bounds(), params.nearest);
    settings.limits = {static_cast<std::size_t>(params.nearest), static_cast<float>(max_radius)};
    settings.flux_unit = photons.flux_per_energy();

    BuildReport report;
    photons.counts.add_to(report.counters);
    report.resolved["max_radius"] = max_radius;
    GlobalMaps maps = order(std::move(photons.store), params, settings, options);
    if (!params.load.empty()) {
        report.resolved["max_bounces"] = kept.origin.max_bounces;
        report.resolved["diffuse_bounces"] =
            kept.origin.diffuse_bounces +
            (params.gather > 0 && kept.origin.diffuse_bounces > 0 ? 1 : 0);
    }
    report.counters["photons_from_diffuse"] = maps.indirect->size();
    if (maps.irradiance) report.counters["irradiance_places"] = maps.irradiance->size();
    if (params.shadow_photons > 0) {
        maps.shadows = std::make_unique<const ShadowMap>(scene, params.shadow_photons, options);
        report.counters["shadow_photons_stored"] = maps.shadows->size();
    }
    report.bytes = maps.bytes();
    return std::make_unique<GlobalPhotonMap>(scene, params, options, std::move(maps),
                                             std::move(report));
}

namespace {

bool is_map_traced(const GlobalMapParams& params) { return params.load.empty(); }

void settle_map(const JsonNode& node, GlobalMapParams& params) {
    const auto precompute = node.find("precompute");
    if (precompute && params.gather == 0)
        precompute->fail("serves the rays of final gathering: gather is 0");
    if (is_map_traced(params)) return;
    for (const char* key : {"save", "photons", "max_bounces", "diffuse_bounces"})
        if (const auto given = node.find(key))
            given->fail("cannot be given with load: the photons of " + params.load.string() +
                        " are there already, traced as that file says");
}

}  // namespace

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
                                          .source = "[C11]"})
                  .only_if(is_map_traced),
              parameter::max_bounces<P>().only_if(is_map_traced),
              parameter::diffuse_bounces<P>().only_if(is_map_traced),
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
                   .source = "[Jensen 1995]"}),
              parameter::whole_number<P>(
                  &P::precompute, 0, 1'000'000,
                  {.key = "precompute",
                   .meaning =
                       "Irradiance is known beforehand at every K-th photon, for rays that end "
                       "on diffuse surfaces; 0: estimated at each end.",
                   .source = "[Christensen 1999]"})
                  .only_if([](const P& p) { return p.gather > 0; }),
              parameter::whole_number<P>(
                  &P::shadow_photons, 0, 1'000'000'000,
                  {.key = "shadow_photons",
                   .meaning = "Rays of each light that leave shadow photons, which spare pictures "
                              "shadow rays; 0: none.",
                   .unit = "rays",
                   .source = "[C11]"}),
              parameter::written_file<P>(
                  &P::save,
                  {.key = "save",
                   .meaning = "File that the traced photons are written to; not in sweeps."}),
              parameter::read_file<P>(
                  &P::load, photon_map_checksum,
                  {.key = "load",
                   .meaning = "File that the photons come from, in place of being traced."})},
         .settle = settle_map,
         .take_least_work = [](P& params) {
             params.photons = 1;
             params.shadow_photons = 0;
             params.save.clear();
         }});
    return method;
}

}  // namespace caustics::photonmap

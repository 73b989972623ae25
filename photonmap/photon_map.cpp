#include "photonmap/photon_map.h"

#include <algorithm>

#include "core/error.h"
#include "core/light_path.h"
#include "photonmap/kd_tree.h"
#include "photonmap/max_radius.h"
#include "photonmap/photon_tracing.h"
#include "photonmap/radiance_estimate.h"

namespace caustics {

namespace {

/// A thread's scratch and counters.
class GatherContext final : public QueryContext {
public:
    explicit GatherContext(std::size_t nearest) : scratch(nearest) {}

    void count(const Gathered& gathered) {
        ++gathers_;
        gathered_photons_ += gathered.photons;
        if (gathered.photons == 0) ++empty_gathers_;
    }
    void add_to(Counters& counters) const override {
        counters["gathers"] += gathers_;
        counters["gathered_photons"] += gathered_photons_;
        counters["empty_gathers"] += empty_gathers_;
    }

    NearestSet scratch;

private:
    std::uint64_t gathers_ = 0;
    std::uint64_t gathered_photons_ = 0;
    std::uint64_t empty_gathers_ = 0;
};

/// A balanced map and the estimate over it.
class PhotonMap final : public CausticEstimator {
public:
    PhotonMap(TracedPhotons photons, const RadianceEstimate::Settings& settings)
        : photons_(std::move(photons)),
          settings_(settings),
          estimate_(std::as_const(photons_.store).photons(), settings) {}

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<GatherContext>(settings_.nearest);
    }

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const override {
        answer(points, out, context, &RadianceEstimate::radiance);
    }

    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const override {
        answer(points, out, context, &RadianceEstimate::irradiance);
    }

    BuildReport build_report() const override {
        BuildReport report;
        report.bytes = photons_.store.bytes();
        photons_.counts.add_to(report.counters);
        report.resolved["max_radius"] = static_cast<double>(settings_.max_radius);
        return report;
    }

private:
    using Query = Gathered (RadianceEstimate::*)(const ReceiverPoint&, NearestSet&) const;

    void answer(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                QueryContext& context, Query query) const {
        auto& own = dynamic_cast<GatherContext&>(context);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Gathered gathered = (estimate_.*query)(points[i], own.scratch);
            own.count(gathered);
            out[i] = {gathered.value, black()};
        }
    }

    TracedPhotons photons_;
    RadianceEstimate::Settings settings_;
    RadianceEstimate estimate_;
};

void check(const PhotonMapParams& params) {
    if ((params.photons == 0) == (params.emitted == 0))
        throw InputError("photonmap: give either photons or emitted");
    const bool unbiased = params.estimator == PhotonMapParams::Estimator::unbiased;
    if (params.nearest < (unbiased ? 2 : 1))
        throw InputError(
            "photonmap: nearest must be at least 1, and 2 with the estimator "
            "\"unbiased\", which leaves the outermost photon out");
    if (!(params.max_radius >= 0)) throw InputError("photonmap: max_radius must be positive");
}

TracedPhotons trace(const Scene& scene, const PhotonMapParams& params, const RunOptions& options) {
    const AimedEmission emission(scene);
    if (emission.empty()) {
        if (params.photons > 0)
            throw UnsupportedScene(
                "photonmap: no photon can be stored, because no light shines on a specular "
                "surface (give `emitted` instead of `photons` to accept an empty map)");
        LightPathCounts counts;
        counts.emitted = params.emitted;
        return {PhotonStore(0), counts, Spectrum::Ones()};
    }
    const auto trace_path = [&](std::uint64_t path, LightPathCounts& counts) {
        Rng rng(options.seed, Stage::photons, path);
        const std::optional<LightParticle> particle = emission.emit(rng);
        if (!particle) return std::optional<Deposit>();
        counts.aimed = 1;
        return trace_light_path(scene, *particle, params.max_bounces, rng, counts);
    };
    const PhotonTarget target{.stored = params.photons, .emitted = params.emitted};
    return trace_photons(trace_path, emission.total_power(), target, options);
}

}  // namespace

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const PhotonMapParams& params,
                                              const RunOptions& options) {
    check(params);
    options.phase("trace");
    TracedPhotons photons = trace(scene, params, options);
    options.phase("balance");
    balance(photons.store.photons());

    RadianceEstimate::Settings settings;
    settings.nearest = static_cast<std::size_t>(params.nearest);
    settings.estimator = params.estimator;
    settings.max_radius = static_cast<float>(
        params.max_radius > 0
            ? params.max_radius
            : default_max_radius(photons.store.photons(), scene.bounds(), params.nearest));
    settings.flux_unit = photons.flux_unit / static_cast<float>(photons.counts.emitted);
    return std::make_unique<PhotonMap>(std::move(photons), settings);
}

}  // namespace caustics

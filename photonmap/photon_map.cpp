#include "photonmap/photon_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "photonmap/estimate/max_radius.h"
#include "photonmap/estimate/radiance_estimate.h"
#include "photonmap/photons/faint_channels.h"
#include "photonmap/photons/photon_source.h"
#include "photonmap/progressive.h"
#include "photonmap/tree/build_tree.h"
#include "photonmap/tree/photon_discs.h"

namespace caustics::photonmap {

namespace {

/// A thread's scratch and counters.
class GatherContext final : public QueryContext {
public:
    GatherContext(bool tables, bool adaptive) : adaptive_(adaptive) {
        if (tables) estimate.table.emplace();
    }

    void count(const GatheredPhotons& gathered) {
        ++gathers_;
        gathered_photons_ += gathered.count;
        if (gathered.count == 0) ++empty_gathers_;
    }
    void add_to(Counters& counters) const override {
        counters["gathers"] += gathers_;
        counters["gathered_photons"] += gathered_photons_;
        counters["empty_gathers"] += empty_gathers_;
        if (scratch.visited_nodes > 0) counters["nodes_visited"] += scratch.visited_nodes;
        if (adaptive_) counters["used_photons"] += estimate.used_photons;
        if (!estimate.table) return;
        counters["table_lookups"] += estimate.table->lookups();
        counters["table_fillings"] += estimate.table->fillings();
    }

    GatherScratch scratch;
    EstimateScratch estimate;
    /// Squares of `footprint` round points, and the points with them.
    std::vector<PixelCell> squares;
    std::vector<ReceiverPoint> points;

private:
    bool adaptive_;
    std::uint64_t gathers_ = 0;
    std::uint64_t gathered_photons_ = 0;
    std::uint64_t empty_gathers_ = 0;
};

/// A tree of photons and the estimate over it.
class PhotonMap final : public CausticEstimator {
public:
    PhotonMap(std::unique_ptr<const PhotonTree> tree, BuildReport report,
              const RadianceEstimate::Settings& settings, const PhotonMapParams& params, Isa isa)
        : tree_(std::move(tree)),
          report_(std::move(report)),
          settings_(settings),
          estimate_(settings, isa),
          tables_(params.tables),
          averages_pixels_(params.averages_pixels()),
          square_(params.kernel == KernelKind::photon ? static_cast<double>(params.footprint) : 0) {
    }

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<GatherContext>(tables_, settings_.adaptive);
    }

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const override {
        auto& own = dynamic_cast<GatherContext&>(context);
        // A batch begins with an empty table, so that the counters do not depend on threads.
        if (own.estimate.table) own.estimate.table->clear();
        answer(points, out, own, &RadianceEstimate::radiance);
    }

    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const override {
        answer(points, out, dynamic_cast<GatherContext&>(context), &RadianceEstimate::irradiance);
    }

    bool asks_for_cells() const override { return averages_pixels_; }
    BuildReport build_report() const override { return report_; }

private:
    using Value = Spectrum (RadianceEstimate::*)(const ReceiverPoint&, const GatheredPhotons&,
                                                 EstimateScratch&) const;

    void answer(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                GatherContext& context, Value value) const {
        if (square_ > 0) points = with_squares(points, context);
        tree_->gather(points, settings_.limits, context.scratch,
                      [&](std::size_t i, const GatheredPhotons& gathered) {
                          context.count(gathered);
                          out[i] = {(estimate_.*value)(points[i], gathered, context.estimate),
                                    black()};
                      });
    }

    std::span<const ReceiverPoint> with_squares(std::span<const ReceiverPoint> points,
                                                GatherContext& context) const {
        context.squares.clear();
        for (const ReceiverPoint& point : points)
            context.squares.push_back(
                PixelCell::square(point.geometric_normal.cast<double>(), square_));
        context.points.assign(points.begin(), points.end());
        for (std::size_t i = 0; i < points.size(); ++i)
            context.points[i].cell = &context.squares[i];
        return context.points;
    }

    std::unique_ptr<const PhotonTree> tree_;
    BuildReport report_;
    RadianceEstimate::Settings settings_;
    RadianceEstimate estimate_;
    bool tables_;
    bool averages_pixels_;
    double
        square_;  ///< side of the square that the photons' own kernels are averaged over [m]; 0: none
};

void check(const PhotonMapParams& params) {
    const int counts = (params.photons > 0) + (params.emitted > 0) + !params.load.empty();
    if (counts != 1 || (!params.load.empty() && !params.save.empty()))
        throw InputError("photonmap: give one of photons, emitted and load; save not with load");
    const bool unbiased = params.estimator == PhotonMapParams::Estimator::unbiased;
    if (params.nearest < (unbiased ? 2 : 1))
        throw InputError(
            "photonmap: nearest must be at least 1, and 2 with the estimator "
            "\"unbiased\", which leaves the outermost photon out");
    if (!(params.max_radius >= 0)) throw InputError("photonmap: max_radius must be positive");
    if (!(params.radius >= 0)) throw InputError("photonmap: radius must be positive");
    if (params.radius > 0 && params.max_radius > 0)
        throw InputError("photonmap: radius takes the place of max_radius: give one of them");
    if (params.passes < 1 || (params.passes > 1 && !(params.load.empty() && params.save.empty())))
        throw InputError("photonmap: passes must be at least 1, and 1 with load and save");
    if (!(params.footprint >= 0)) throw InputError("photonmap: footprint must be positive");
    if (params.footprint > 0 && (params.adaptive || !unbiased || params.filter_alpha > 0))
        throw InputError(
            "photonmap: footprint averages over squares, without adaptive, filter_alpha and the "
            "estimator \"raw\"");
    if (params.kernel == KernelKind::photon &&
        (params.tree != TreeKind::packed || params.adaptive || !unbiased ||
         params.filter_alpha > 0))
        throw InputError(
            "photonmap: the kernel \"photon\" goes with the tree \"packed\", without adaptive, "
            "filter_alpha and the estimator \"raw\"; those go with \"point\"");
    if (!params.adaptive) return;
    if (params.radius > 0)
        throw InputError("photonmap: a fixed radius leaves no N for adaptive to choose");
    if (params.nearest < PhotonMapParams::least_adaptive_nearest ||
        params.nearest > PhotonMapParams::most_adaptive_nearest)
        throw InputError("photonmap: nearest, the largest N, must be 20 to 100000 with adaptive");
}

GatherLimits limits(const PhotonMapParams& params, const Scene& scene, const PhotonStore& photons,
                    int pass) {
    const bool at_points = params.kernel == KernelKind::point;
    const bool positions = params.adaptive || params.footprint > 0;
    const auto margin =
        at_points
            ? static_cast<float>(RadianceEstimate::margin_of(static_cast<double>(params.footprint)))
            : 0.0F;
    if (params.radius > 0)
        return {GatherLimits::all, static_cast<float>(params.radius * std::sqrt(pass_share(pass))),
                positions, margin};
    // From the photons in the order of their paths, so that it is the same for every tree.
    const double max_radius =
        params.max_radius > 0
            ? params.max_radius
            : default_max_radius(photons.photons(), scene.bounds(), params.nearest);
    return {static_cast<std::size_t>(params.nearest), static_cast<float>(max_radius), positions,
            margin};
}

/// Announces the phases "balance" and, for photons with discs of their own, "widths".
std::unique_ptr<const PhotonTree> ordered(PhotonStore photons, const PhotonMapParams& params,
                                          const RadianceEstimate::Settings& settings,
                                          const RunOptions& options) {
    options.phase("balance");
    if (params.kernel == KernelKind::point)
        return build_tree(params.tree, std::move(photons), options.isa, options.threads);
    auto tree = std::make_unique<PackedKdTree>(std::move(photons), options.isa, options.threads);
    options.phase("widths");
    const DiscWidths widths{.nearest = settings.limits.nearest,
                            .max_radius = settings.limits.max_radius,
                            .fixed = params.radius > 0,
                            .share = settings.share};
    const bool cells = params.averages_pixels() || params.footprint > 0;
    const double reach = cells ? CellKernel(settings.filter).reach() : 0;
    return std::make_unique<PhotonDiscs>(std::move(tree), widths, static_cast<float>(reach),
                                         options);
}

/// Half the width of the narrowest lobe of a receiver [deg], where photons' directions, kept in steps of 1.4 degrees [J96],
/// blur it by some percent.
std::optional<double> blurred_lobe(const Scene& scene) {
    constexpr float sharp = 4;
    float narrowest = sharp;
    for (const Shape& shape : scene.shapes())
        if (const auto width = lobe_half_width(shape.bsdf))
            narrowest = std::min(narrowest, *width * 180 / pi);
    return narrowest < sharp ? std::optional<double>(narrowest) : std::nullopt;
}

}  // namespace

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const PhotonMapParams& params,
                                              const RunOptions& options) {
    return build_pass(scene, params, options, 0);
}

std::unique_ptr<const CausticEstimator> build_pass(const Scene& scene,
                                                   const PhotonMapParams& params,
                                                   const RunOptions& options, int pass) {
    check(params);
    RunOptions own = options;
    own.seed = pass_seed(options.seed, pass);
    SavedPhotons kept = photon_source(scene, params, own, pass == 0 ? AskYield::yes : AskYield::no);
    TracedPhotons& photons = kept.photons;
    RadianceEstimate::Settings settings;
    settings.estimator = params.estimator;
    settings.filter = {params.filter, params.filter_k, params.filter_beta, params.filter_alpha};
    settings.adaptive = params.adaptive;
    settings.share = params.radius > 0 ? 1 : pass_share(pass);
    settings.limits = limits(params, scene, photons.store, pass);
    if (params.kernel == KernelKind::point)
        settings.footprint = static_cast<double>(params.footprint);
    settings.flux_unit = photons.flux_per_energy();

    BuildReport report;
    // What changes no picture is not reported.
    if (const double faint = faint_flux_share(photons.store.photons()); faint >= 0.01)
        report.resolved["faint_flux_share"] = faint;
    if (const auto lobe = blurred_lobe(scene)) report.resolved["blurred_lobe_degrees"] = *lobe;

    std::unique_ptr<const PhotonTree> tree =
        ordered(std::move(photons.store), params, settings, options);
    report.bytes = tree->bytes();
    photons.counts.add_to(report.counters);
    // A file keeps no light.
    if (params.load.empty()) report.light = photons.counts.watts();
    tree->add_to(report.counters);
    if (params.radius == 0)
        report.resolved["max_radius"] = static_cast<double>(settings.limits.max_radius);
    // Nearest N alone does not keep the light's sum.
    if (params.kernel == KernelKind::point && params.radius == 0)
        report.resolved["sum_not_kept"] = 1;
    if (!params.load.empty()) report.resolved["max_bounces"] = kept.origin.max_bounces;
    if (kept.version < first_version_with_surfaces)
        report.resolved["photon_map_version"] = kept.version;
    return std::make_unique<PhotonMap>(std::move(tree), std::move(report), settings, params,
                                       options.isa);
}

}  // namespace caustics::photonmap

#include "core/reference/light_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/material/optics.h"
#include "core/reference/gather_grid.h"
#include "core/reference/ordered_paths.h"
#include "core/scene/eye_medium.h"

namespace caustics {
namespace {

// Sums of what paths brought to each of a number of cells (pixels or probe points).
class Tally {
public:
    explicit Tally(std::size_t cells) : random_(cells) {}

    // Of a random path; a path's values come one after the other. Where it comes to a cell again its values are one.
    void add(std::uint64_t path, std::size_t cell, const Spectrum& value) {
        Random& c = random_[cell];
        const SpectrumSum v = value.cast<double>();
        if (c.path != path) c.of_path.setZero();
        c.path = path;
        c.sum += v;
        c.squares += v * (v + 2 * c.of_path);
        c.of_path += v;
        ++added_;
    }
    // Of a path of the batch, whose paths depend on each other.
    void add_to_batch(std::size_t cell, const Spectrum& value) {
        batch_.resize(random_.size(), SpectrumSum::Zero());
        batch_[cell] += value.cast<double>();
        ++added_;
    }
    // Batches are alike and independent.
    void end_batch() {
        batch_.resize(random_.size(), SpectrumSum::Zero());
        batch_sum_.resize(random_.size(), SpectrumSum::Zero());
        batch_squares_.resize(random_.size(), SpectrumSum::Zero());
        for (std::size_t cell = 0; cell < batch_.size(); ++cell) {
            batch_sum_[cell] += batch_[cell];
            batch_squares_[cell] += batch_[cell].square();
            batch_[cell].setZero();
        }
        ++batches_;
    }

    std::uint64_t added() const { return added_; }
    // Mean over n paths, `random` of them outside of batches.
    Estimate estimate(std::size_t cell, double n, double random) const {
        const SpectrumSum &sum = random_[cell].sum, &squares = random_[cell].squares;
        if (batches_ == 0) {
            const SpectrumSum mean = sum / n;
            const SpectrumSum variance = (squares / n - mean.square()).max(0) / n;
            return {mean.cast<float>(), variance.sqrt().cast<float>()};
        }
        const SpectrumSum mean = (batch_sum_[cell] + sum) / n;
        const double count = batches_;
        SpectrumSum variance =
            (batch_squares_[cell] - batch_sum_[cell].square() / count).max(0) * count / (count - 1);
        if (random > 0) variance += (squares - sum.square() / random).max(0);
        return {mean.cast<float>(), (variance.sqrt() / n).cast<float>()};
    }

private:
    struct Random {
        SpectrumSum sum = SpectrumSum::Zero(), squares = SpectrumSum::Zero();
        SpectrumSum of_path = SpectrumSum::Zero();  // what the last path has brought until now
        std::uint64_t path = std::numeric_limits<std::uint64_t>::max();
    };
    std::vector<Random> random_;
    std::vector<SpectrumSum> batch_, batch_sum_, batch_squares_;
    int batches_ = 0;
    std::uint64_t added_ = 0;
};

// Number of batches of even paths. Larger batches have less noise: the variance of a pixel's mean grows as the root of this number.
constexpr std::uint64_t batches = 4;

struct LightTraceContext : QueryContext {
    LightPathCounts counts;
    void add_to(Counters& counters) const override { counts.add_to(counters); }
};

struct Arrival {
    std::uint64_t path;
    std::size_t cell;
    Spectrum value;
};

/// Which paths are traced: caustics, or, where `whole`, all, of which indirect light counts.
struct Paths {
    Stage stage = Stage::light_trace;
    std::optional<WholePathSettings> whole = {};
};

template <class Estimator>
class LightTrace : public Estimator {
public:
    LightTrace(const Scene& scene, const LightTraceParams& params, const Paths& paths,
               const RunOptions& options)
        : scene_(scene),
          params_(params),
          paths_(paths),
          options_(options),
          emission_(scene, options.isa, paths.whole ? Aim::everywhere : Aim::casters),
          film_(scene.camera()),
          eye_absorption_(eye_medium(scene).absorption) {
        if (params.emission == LightTraceParams::Emission::stratified)
            even_ = EvenPaths::at_most(emission_, params.paths / batches);
    }

    std::optional<CameraLayer> camera_layer(const RunOptions& options) const override {
        const Camera& camera = scene_.camera();
        const auto cells =
            static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
        LightPathCounts counts;
        const auto collect = [&](const Deposit& d, std::uint64_t path, std::vector<Arrival>& out) {
            if (const auto arrival = connect(d, path)) out.push_back(*arrival);
        };
        const Tally tally = trace(cells, options, collect, counts);
        CameraLayer layer;
        counts.add_to(layer.counters);
        if (!paths_.whole) layer.light = counts.watts();
        layer.counters["photons_connected"] = tally.added();
        for (std::size_t i = 0; i < cells; ++i) {
            const Estimate e = estimate(tally, i);
            layer.radiance.push_back(e.value);
            layer.standard_error.push_back(e.standard_error);
        }
        return layer;
    }

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<LightTraceContext>();
    }
    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext& context) const override {
        gather(points, out, context, [](const ReceiverPoint& p, const Deposit& d) -> Spectrum {
            return d.flux * evaluate(*p.bsdf, p.uv, p.shading_normal, p.wo, d.wi);
        });
    }
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext& context) const override {
        gather(points, out, context,
               [](const ReceiverPoint&, const Deposit& d) -> Spectrum { return d.flux; });
    }
    bool is_statistical() const override { return true; }

private:
    // `collect` says what a path's deposit brings to which cells.
    template <typename Collect>
    Tally trace(std::size_t cells, const RunOptions& options, const Collect& collect,
                LightPathCounts& total) const {
        Tally tally(cells);
        OrderedPaths paths{scene_,        emission_,    params_.paths, params_.max_bounces,
                           options_.seed, paths_.stage, paths_.whole};
        for (std::uint64_t batch = 0; even_ && batch < batches; ++batch) {
            paths.paths = even_->size();
            paths.even = even_;
            if (disperses(scene_))
                paths.wavelength_shift = Rng(options_.seed, Stage::wavelength, batch).next_fine();
            total.add(trace_in_order<Arrival>(paths, part_of(options, paths), collect,
                                              [&tally](const Arrival& arrival) {
                                                  tally.add_to_batch(arrival.cell, arrival.value);
                                              }));
            tally.end_batch();
            paths.first += paths.paths;
        }
        paths.paths = params_.paths - paths.first;
        paths.even.reset();
        paths.wavelength_shift.reset();
        total.add(trace_in_order<Arrival>(paths, part_of(options, paths), collect,
                                          [&tally](const Arrival& arrival) {
                                              tally.add(arrival.path, arrival.cell, arrival.value);
                                          }));
        return tally;
    }

    // Progress of some of the paths as that of all.
    RunOptions part_of(const RunOptions& options, const OrderedPaths& part) const {
        RunOptions own = options;
        const auto all = static_cast<double>(params_.paths);
        const double from = static_cast<double>(part.first) / all;
        const double share = static_cast<double>(part.paths) / all;
        if (options.progress)
            own.progress = [=, &options](double done) { options.progress(from + share * done); };
        return own;
    }

    Estimate estimate(const Tally& tally, std::size_t cell) const {
        const std::uint64_t stratified = even_ ? batches * even_->size() : 0;
        return tally.estimate(cell, static_cast<double>(params_.paths),
                              static_cast<double>(params_.paths - stratified));
    }

    // The pixel average of the radiance a deposit sends to the pinhole: with film area dp at unit
    // distance, dp cos^3(theta) = dA cos(receiver) / distance^2.
    std::optional<Arrival> connect(const Deposit& d, std::uint64_t path) const {
        const auto seen = film_.project(d.position);
        if (!seen) return {};
        const Camera& camera = scene_.camera();
        const Vec3 eye = camera.position();
        const Vec3 wo = (eye - d.position).normalized();
        const float cosine = d.geometric_normal.dot(wo);
        if (cosine <= 0) return {};
        const Spectrum scattering =
            evaluate(scene_.shapes()[d.shape].bsdf, d.uv, d.shading_normal, wo, d.wi);
        if (is_black(scattering)) return {};
        if (scene_.occluded({d.position, d.geometric_normal, d.offset}, SegmentEnd{eye})) return {};
        const double cos3 = seen->cos_theta * seen->cos_theta * seen->cos_theta;
        const double weight = static_cast<double>(cosine) /
                              (seen->distance * seen->distance * cos3 * film_.pixel_area());
        const auto pixel =
            static_cast<std::size_t>(seen->y) * static_cast<std::size_t>(camera.width) +
            static_cast<std::size_t>(seen->x);
        const Spectrum left =
            segment_transmittance(nullptr, &eye_absorption_, static_cast<float>(seen->distance));
        return Arrival{path, pixel, d.flux * scattering * static_cast<float>(weight) * left};
    }

    template <typename Value>
    void gather(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                QueryContext& context, const Value& value) const {
        std::vector<float> radii;
        for (const ReceiverPoint& p : points) {
            radii.push_back(p.radius > 0 ? p.radius : static_cast<float>(params_.radius));
            if (radii.back() <= 0)
                throw InputError(
                    "lighttrace gathers over a disc at each point: give a column `radius` or "
                    "the parameter radius");
        }
        const GatherGrid grid(points, radii);
        const auto collect = [&](const Deposit& d, std::uint64_t path,
                                 std::vector<Arrival>& arrivals) {
            grid.for_each_containing(d, [&](std::size_t i) {
                const float area = pi * radii[i] * radii[i];
                arrivals.push_back({path, i, value(points[i], d) / area});
            });
        };
        const Tally tally = trace(points.size(), options_, collect,
                                  static_cast<LightTraceContext&>(context).counts);
        for (std::size_t i = 0; i < points.size(); ++i) {
            out[i] = estimate(tally, i);
            if (is_black(out[i].value) && is_black(out[i].standard_error))
                out[i].standard_error = error_without_paths(points[i], radii[i], value);
        }
    }

    // Where no path came the error is that of one path, not 0: three times as much holds in 95 % of cases (rule of
    // three, Hanley & Lippman-Hand 1983).
    template <typename Value>
    Spectrum error_without_paths(const ReceiverPoint& point, float radius,
                                 const Value& value) const {
        const bool is_dark = point.bsdf != nullptr && !scatters_from(*point.bsdf, point.front);
        if (is_dark || emission_.empty()) return black();
        Deposit one;
        one.flux = emission_.total_power() / static_cast<float>(params_.paths);
        one.wi = point.geometric_normal;
        return value(point, one) / (pi * radius * radius);
    }

    const Scene& scene_;
    LightTraceParams params_;
    Paths paths_;
    RunOptions options_;
    AimedEmission emission_;
    FilmProjection film_;
    Spectrum eye_absorption_;
    std::optional<EvenPaths> even_;  // one batch
};

template <class P>
std::vector<Parameter<P>> path_parameters() {
    return {
        parameter::whole_number<P>(&P::paths, 1, 1'000'000'000'000,
                                   {.key = "paths",
                                    .meaning = "Light paths emitted, thinned ones included.",
                                    .unit = "paths"}),
        parameter::max_bounces<P>(),
        parameter::optional_length<P>(
            &P::radius, "leave it out where each point has its own",
            {.key = "radius",
             .meaning = "In probe: radius of the disc round points that have none of their own."})
            .usually("none")};
}

MethodFacts facts(const std::string& summary) {
    return {.name = "lighttrace",
            .summary = summary,
            .serves =
                "every light; not pixels that see the receiver through glass (layer "
                "`unreached`)",
            .is_unbiased = true,
            .samples = {.parameter = "paths"},
            .work = {.parameter = "paths", .first = 1000, .most = 1'000'000'000'000},
            .gathers_over_discs = true};
}

std::vector<Parameter<LightTraceParams>> caustic_parameters() {
    using P = LightTraceParams;
    std::vector<Parameter<P>> parameters = path_parameters<P>();
    parameters.push_back(
        parameter::choice<P>(
            &P::emission,
            {{"random", P::Emission::random}, {"stratified", P::Emission::stratified}},
            {.key = "emission",
             .meaning = "Draws light paths at random, or in four batches that are spread evenly."})
            .only_if([](const P& p) { return p.emission != P::Emission::random; }));
    return parameters;
}

template <class P>
void check_radius(const JsonNode& node, P&) {
    if (const auto radius = node.find("radius")) radius->as_number_in(0, 1e12);
}

void settle(const JsonNode& node, LightTraceParams& params) {
    check_radius(node, params);
    if (const auto emission = node.find("emission");
        emission && params.emission == LightTraceParams::Emission::stratified &&
        params.paths < batches)
        emission->fail(
            "\"stratified\" takes four paths or more, one in each batch (or take \"random\")");
}

}  // namespace

const DescribedMethod<LightTraceParams>& lighttrace_method() {
    using P = LightTraceParams;
    static const DescribedMethod<P> method(
        {.facts = facts("particle tracing connected to the camera; `probe` gathers its particles "
                        "over a disc at each point"),
         .parameters = caustic_parameters(),
         .settle = settle,
         .take_share =
             [](P& params, double share) {
                 // Stratified paths need one in each batch.
                 const double least = batches / static_cast<double>(params.paths);
                 return take_share_of(params.paths, std::clamp(share, std::min(least, 1.0), 1.0));
             },
         .disc_radius = &P::radius});
    return method;
}

const DescribedMethod<IndirectLightTraceParams, IndirectEstimator>& indirect_lighttrace_method() {
    using P = IndirectLightTraceParams;
    static const DescribedMethod<P, IndirectEstimator> method([] {
        std::vector<Parameter<P>> parameters = path_parameters<P>();
        parameters.push_back(parameter::diffuse_bounces<P>());
        return MethodTable<P, IndirectEstimator>{
            .facts = facts("particle tracing through all surfaces, connected to the camera"),
            .parameters = std::move(parameters),
            .settle = check_radius<P>,
            .disc_radius = static_cast<double P::*>(&P::radius)};
    }());
    return method;
}

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const LightTraceParams& params,
                                              const RunOptions& options) {
    return std::make_unique<LightTrace<CausticEstimator>>(scene, params, Paths{}, options);
}

std::unique_ptr<const IndirectEstimator> build(const Scene& scene,
                                               const IndirectLightTraceParams& params,
                                               const RunOptions& options) {
    const Paths paths{Stage::indirect_light_trace,
                      WholePathSettings{params.max_bounces, params.diffuse_bounces}};
    return std::make_unique<LightTrace<IndirectEstimator>>(scene, params, paths, options);
}

}  // namespace caustics

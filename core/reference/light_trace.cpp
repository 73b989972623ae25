#include "core/reference/light_trace.h"

#include <algorithm>
#include <cmath>

#include "core/aimed_emission.h"
#include "core/error.h"
#include "core/light_path.h"
#include "core/parallel.h"
#include "core/reference/gather_grid.h"

namespace caustics {
namespace {

constexpr std::uint64_t paths_per_chunk = 4096;
constexpr std::uint64_t chunks_per_round = 256;

// Sums of what paths brought to each of a number of cells (pixels or probe points).
struct Tally {
    std::vector<SpectrumSum> sum, squares;

    explicit Tally(std::size_t cells)
        : sum(cells, SpectrumSum::Zero()), squares(cells, SpectrumSum::Zero()) {}

    void add(std::size_t cell, const Spectrum& value) {
        const SpectrumSum v = value.cast<double>();
        sum[cell] += v;
        squares[cell] += v * v;
    }
    // Mean over n paths, each of which brought at most one value to a cell.
    Estimate estimate(std::size_t cell, double n) const {
        const SpectrumSum mean = sum[cell] / n;
        const SpectrumSum variance = (squares[cell] / n - mean.square()).max(0) / n;
        return {mean.cast<float>(), variance.sqrt().cast<float>()};
    }
};

struct LightTraceContext : QueryContext {
    LightPathCounts counts;
    void add_to(Counters& counters) const override { counts.add_to(counters); }
};

struct Arrival {
    std::size_t cell;
    Spectrum value;
};

class LightTrace : public CausticEstimator {
public:
    LightTrace(const Scene& scene, const LightTraceParams& params, const RunOptions& options)
        : scene_(scene),
          params_(params),
          options_(options),
          emission_(scene),
          film_(scene.camera()) {}

    std::optional<CameraLayer> camera_layer(const RunOptions& options) const override {
        const Camera& camera = scene_.camera();
        const auto cells =
            static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
        LightPathCounts counts;
        const auto collect = [&](const Deposit& d, std::vector<Arrival>& out) {
            if (const auto arrival = connect(d)) out.push_back(*arrival);
        };
        const Tally tally = trace(cells, options, collect, counts);
        CameraLayer layer;
        counts.add_to(layer.counters);
        for (std::size_t i = 0; i < cells; ++i) {
            const Estimate e = tally.estimate(i, static_cast<double>(params_.paths));
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
    // Traces every path in rounds of chunks; `collect` says what a deposit brings to which cells.
    // Chunks are summed in their order, so that threads change nothing.
    template <typename Collect>
    Tally trace(std::size_t cells, const RunOptions& options, const Collect& collect,
                LightPathCounts& total) const {
        Tally tally(cells);
        const std::uint64_t chunks = (params_.paths + paths_per_chunk - 1) / paths_per_chunk;
        std::vector<std::vector<Arrival>> arrivals(chunks_per_round);
        std::vector<LightPathCounts> counts(chunks_per_round);
        for (std::uint64_t first = 0; first < chunks; first += chunks_per_round) {
            const std::uint64_t in_round = std::min(chunks_per_round, chunks - first);
            parallel_for(options.threads, in_round, [&](std::size_t i, std::size_t) {
                arrivals[i].clear();
                counts[i] = {};
                trace_chunk(first + i, counts[i],
                            [&](const Deposit& d) { collect(d, arrivals[i]); });
            });
            for (std::size_t i = 0; i < in_round; ++i) {
                for (const Arrival& arrival : arrivals[i]) tally.add(arrival.cell, arrival.value);
                total.add(counts[i]);
            }
            options.report(static_cast<double>(first + in_round) / static_cast<double>(chunks));
        }
        return tally;
    }

    template <typename Sink>
    void trace_chunk(std::uint64_t chunk, LightPathCounts& counts, const Sink& sink) const {
        const std::uint64_t begin = chunk * paths_per_chunk;
        const std::uint64_t end = std::min(begin + paths_per_chunk, params_.paths);
        for (std::uint64_t path = begin; path < end; ++path) {
            Rng rng(options_.seed, Stage::light_trace, path);
            ++counts.emitted;
            const std::optional<LightParticle> particle = emission_.emit(rng);
            if (!particle) continue;
            ++counts.aimed;
            if (const auto deposit =
                    trace_light_path(scene_, *particle, {params_.max_bounces}, rng, counts))
                sink(*deposit);
        }
    }

    // The pixel average of the radiance a deposit sends to the pinhole: with film area dp at unit
    // distance, dp cos^3(theta) = dA cos(receiver) / distance^2.
    std::optional<Arrival> connect(const Deposit& d) const {
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
                              (seen->distance * seen->distance * cos3 * camera.pixel_area());
        const auto pixel =
            static_cast<std::size_t>(seen->y) * static_cast<std::size_t>(camera.width) +
            static_cast<std::size_t>(seen->x);
        return Arrival{pixel, d.flux * scattering * static_cast<float>(weight)};
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
                    "--param radius=metres");
        }
        const GatherGrid grid(points, radii);
        const auto collect = [&](const Deposit& d, std::vector<Arrival>& arrivals) {
            grid.for_each_containing(d.position, d.wi, [&](std::size_t i) {
                const float area = pi * radii[i] * radii[i];
                arrivals.push_back({i, value(points[i], d) / area});
            });
        };
        const Tally tally = trace(points.size(), options_, collect,
                                  static_cast<LightTraceContext&>(context).counts);
        for (std::size_t i = 0; i < points.size(); ++i)
            out[i] = tally.estimate(i, static_cast<double>(params_.paths));
    }

    const Scene& scene_;
    LightTraceParams params_;
    RunOptions options_;
    AimedEmission emission_;
    FilmProjection film_;
};

}  // namespace

void read(const JsonNode& node, LightTraceParams& params) {
    if (const auto paths = node.find("paths"))
        params.paths = static_cast<std::uint64_t>(paths->as_integer_in(1, 1'000'000'000'000));
    if (const auto bounces = node.find("max_bounces"))
        params.max_bounces = static_cast<int>(bounces->as_integer_in(1, 1000));
    if (const auto radius = node.find("radius")) {
        params.radius = radius->as_number_in(0, 1e12);
        if (params.radius == 0) radius->fail("must be above 0");
    }
    node.finish();
}

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const LightTraceParams& params,
                                              const RunOptions& options) {
    return std::make_unique<LightTrace>(scene, params, options);
}

}  // namespace caustics

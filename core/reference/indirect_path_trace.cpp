#include "core/reference/indirect_path_trace.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/light_path/whole_path.h"
#include "core/reference/backward_chain.h"
#include "core/reference/caustic_sample.h"
#include "core/reference/sample_mean.h"
#include "core/render/direct_light.h"

namespace caustics {
namespace {

// Every path goes on from its first receivers, the one that is seen among them.
constexpr int sure_receivers = 2;

class IndirectPathTrace : public IndirectEstimator {
public:
    IndirectPathTrace(const Scene& scene, const IndirectPathTraceParams& params,
                      const RunOptions& options)
        : scene_(scene),
          params_(params),
          seed_(options.seed),
          paths_per_point_(paths_per_point(params.spp, options)),
          caster_bounds_(caster_bounds(scene)) {}

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = estimate(points[i], 1);
    }
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i)
            out[i] = estimate(white_point(points[i]), pi);
    }
    bool is_statistical() const override { return true; }

private:
    /// A path as far as it has come: what one unit of light from there brings to the first receiver.
    struct Path {
        Spectrum weight = Spectrum::Ones();
        BackwardChain chain = {};
        float pdf = 0;    ///< of the chain's direction [1/sr]
        float share = 1;  ///< of the light from there that the last receiver sends on
    };

    Estimate estimate(const ReceiverPoint& point, float factor) const {
        Rng rng(seed_, Stage::indirect_path_trace, point.id);
        return mean_of(paths_per_point_, [&]() -> Spectrum { return factor * sample(point, rng); });
    }

    Spectrum sample(const ReceiverPoint& start, Rng& rng) const {
        Spectrum light = black();
        Path path;
        path.chain.wavelength.nm = start.nm;
        ReceiverPoint at = start;
        for (int receivers = 1; turn(at, path, rng); ++receivers) {
            const auto hit = scene_.intersect(path.chain.ray);
            // At the receiver that the light comes to first, it is direct or a caustic.
            if (receivers > 1) light += path.weight * met(hit, path);
            if (receivers == params_.diffuse_bounces || !goes_on(receivers, path, rng)) break;
            const auto ahead = receiver_ahead(scene_, path.chain, hit, params_.max_bounces, rng);
            if (!ahead) break;
            path.weight *= ahead->weight;
            at = ahead->point;
            light += path.weight * arriving(at, rng);
        }
        return light;
    }

    // Into a direction of f_r; false where that is below the surface.
    static bool turn(const ReceiverPoint& at, Path& path, Rng& rng) {
        const float u0 = rng.next();
        const float u1 = rng.next();
        const float u2 = rng.next();
        const auto wi = sample_direction(*at.bsdf, at.shading_normal, at.wo, u0, u1, u2);
        if (!wi) return false;
        const float cosine = at.geometric_normal.dot(*wi);
        path.pdf = direction_pdf(*at.bsdf, at.shading_normal, at.wo, *wi);
        if (!(cosine > 0) || !(path.pdf > 0)) return false;
        const Spectrum after = path.weight * (cosine / path.pdf) *
                               evaluate(*at.bsdf, at.uv, at.shading_normal, at.wo, *wi);
        // Of the light before a mirror was asked for it.
        path.share = after.mean() / (path.weight.mean() * (1 - path.chain.specular));
        path.weight = after;
        path.chain = {.ray = spawn_ray({at.position, at.geometric_normal, at.offset}, *wi),
                      .wavelength = path.chain.wavelength,
                      .start_absorption = at.medium};
        return path.share > 0;
    }

    // The first receivers bring most of the light; behind them a path ends by chance as light does.
    static bool goes_on(int receivers, Path& path, Rng& rng) {
        require_end(receivers);
        if (receivers <= sure_receivers) return true;
        const float kept = std::min(1.0F, path.share);
        path.weight /= kept;
        return rng.next() < kept;
    }

    // Direct light that comes along the chain's ray, its share of two ways to find it.
    Spectrum met(const std::optional<SurfacePoint>& hit, const Path& path) const {
        const MetLight found =
            met_light(scene_, hit, path.chain.ray.direction, hit ? hit->distance : 0);
        const Spectrum clear = hit ? segment_transmittance(scene_.area_light_medium(hit->shape),
                                                           nullptr, hit->distance)
                                   : Spectrum(Spectrum::Ones());
        return found.radiance * clear * (path.pdf / (found.pdf + path.pdf));
    }

    // Of direct light by samples of lights, and of caustics, leaving a point of the path.
    Spectrum arriving(const ReceiverPoint& at, Rng& rng) const {
        Spectrum light = sampled_light(scene_, at, rng, Cosine::geometric);
        if (caster_bounds_.empty()) return light;
        const DirectionMixture mixture(caster_bounds_, at);
        return light + caustic_sample(scene_, at, mixture, true, params_.max_bounces, rng);
    }

    const Scene& scene_;
    IndirectPathTraceParams params_;
    std::uint64_t seed_;
    int paths_per_point_;
    std::vector<BoundingSphere> caster_bounds_;
};

}  // namespace

const DescribedMethod<IndirectPathTraceParams, IndirectEstimator>& indirect_pathtrace_method() {
    using P = IndirectPathTraceParams;
    static const DescribedMethod<P, IndirectEstimator> method(
        {.facts = {.name = "pathtrace",
                   .summary = "path tracing with next-event estimation",
                   .serves = "lights with area; any light where nothing is a caster",
                   .is_unbiased = true,
                   .samples = {.parameter = "spp", .of_a_pixel = true}},
         .parameters = {
             parameter::whole_number<P>(
                 &P::spp, 1, 1'000'000'000,
                 {.key = "spp",
                  .meaning =
                      "Paths a pixel, shared among its camera samples; in probe, paths a point.",
                  .unit = "paths"}),
             parameter::max_bounces<P>(), parameter::diffuse_bounces<P>()}});
    return method;
}

std::unique_ptr<const IndirectEstimator> build(const Scene& scene,
                                               const IndirectPathTraceParams& params,
                                               const RunOptions& options) {
    for (const Light& light : scene.lights())
        if (!has_extent(light) && !scene.casters().empty())
            throw UnsupportedScene(
                "pathtrace cannot serve the indirect light of a scene with casters and a " +
                type_of(light) +
                " light: the caustics that light up other walls would be black; use lighttrace or "
                "globalphotonmap, or give the light area");
    return std::make_unique<IndirectPathTrace>(scene, params, options);
}

}  // namespace caustics

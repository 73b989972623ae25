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
        Spectrum weight;
        BackwardChain chain;
    };

    Estimate estimate(const ReceiverPoint& point, float factor) const {
        Rng rng(seed_, Stage::indirect_path_trace, point.id);
        return mean_of(paths_per_point_, [&]() -> Spectrum { return factor * sample(point, rng); });
    }

    Spectrum sample(const ReceiverPoint& start, Rng& rng) const {
        Spectrum light = black();
        Path path{Spectrum::Ones(), {.ray = {}, .wavelength = {.nm = start.nm}}};
        ReceiverPoint at = start;
        // At the receiver that the light comes to first, it is direct or a caustic.
        for (int receivers = 1; receivers != params_.diffuse_bounces; ++receivers) {
            require_end(receivers);
            if (!turn(at, path, rng)) return light;
            const auto ahead = receiver_ahead(scene_, path.chain, params_.max_bounces, rng);
            if (!ahead) return light;
            path.weight *= ahead->weight;
            at = ahead->point;
            light += path.weight * arriving(at, rng);
        }
        return light;
    }

    // Into a direction of f_r; false for the end by chance, whose survivors have the same weight.
    static bool turn(const ReceiverPoint& at, Path& path, Rng& rng) {
        const float u0 = rng.next();
        const float u1 = rng.next();
        const float u2 = rng.next();
        const float u3 = rng.next();
        const auto wi = sample_direction(*at.bsdf, at.shading_normal, at.wo, u0, u1, u2);
        if (!wi) return false;
        const float cosine = at.geometric_normal.dot(*wi);
        const float pdf = direction_pdf(*at.bsdf, at.shading_normal, at.wo, *wi);
        if (!(cosine > 0) || !(pdf > 0)) return false;
        const Spectrum after =
            path.weight * evaluate(*at.bsdf, at.uv, at.shading_normal, at.wo, *wi) * (cosine / pdf);
        const float kept = std::min(1.0F, after.mean() / path.weight.mean());
        if (!(u3 < kept)) return false;
        path.weight = after / kept;
        path.chain = {.ray = spawn_ray({at.position, at.geometric_normal, at.offset}, *wi),
                      .wavelength = path.chain.wavelength,
                      .start_absorption = at.medium};
        return true;
    }

    // Of direct light and caustics, leaving a point of the path.
    Spectrum arriving(const ReceiverPoint& at, Rng& rng) const {
        Spectrum light = direct_radiance(scene_, at, rng, Shadows::opaque, Cosine::geometric);
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

#include "core/reference/path_trace.h"

#include "core/base/error.h"
#include "core/math/rng.h"
#include "core/reference/caustic_sample.h"
#include "core/reference/sample_mean.h"

namespace caustics {
namespace {

class PathTrace : public CausticEstimator {
public:
    PathTrace(const Scene& scene, const PathTraceParams& params, const RunOptions& options)
        : scene_(scene),
          seed_(options.seed),
          max_bounces_(params.max_bounces),
          paths_per_point_(paths_per_point(params.spp, options)),
          caster_bounds_(caster_bounds(scene)) {}

    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = estimate(points[i], true);
    }
    void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                    QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = estimate(points[i], false);
    }
    bool is_statistical() const override { return true; }

private:
    Estimate estimate(const ReceiverPoint& point, bool with_bsdf) const {
        // Irradiance needs no viewer and no material: cosine lobe about the true normal.
        const ReceiverPoint receiver = with_bsdf ? point : white_point(point);
        const DirectionMixture mixture(caster_bounds_, receiver);
        Rng rng(seed_, Stage::path_trace, point.id);
        return mean_of(paths_per_point_, [&] {
            return caustic_sample(scene_, receiver, mixture, with_bsdf, max_bounces_, rng);
        });
    }

    const Scene& scene_;
    std::uint64_t seed_;
    int max_bounces_;
    int paths_per_point_;
    std::vector<BoundingSphere> caster_bounds_;
};

}  // namespace

const DescribedMethod<PathTraceParams>& pathtrace_method() {
    using P = PathTraceParams;
    static const DescribedMethod<P> method(
        {.facts = {.name = "pathtrace",
                   .summary = "unidirectional path tracing with multiple importance sampling",
                   .serves = "lights with area",
                   .is_unbiased = true,
                   .samples = {.parameter = "spp", .of_a_pixel = true},
                   .work = {.parameter = "spp", .most = 1'000'000'000}},
         .parameters = {
             parameter::whole_number<P>(
                 &P::spp, 1, 1'000'000'000,
                 {.key = "spp",
                  .meaning =
                      "Paths a pixel, shared among its camera samples; in probe, paths a point.",
                  .unit = "paths"}),
             parameter::max_bounces<P>()}});
    return method;
}

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const PathTraceParams& params,
                                              const RunOptions& options) {
    for (const Light& light : scene.lights())
        if (!has_extent(light))
            throw UnsupportedScene(
                "pathtrace cannot serve a scene with a " + type_of(light) +
                " light: a path from the receiver hits it with probability zero, so its caustic "
                "would be black; use lighttrace, or give the light area");
    return std::make_unique<PathTrace>(scene, params, options);
}

}  // namespace caustics

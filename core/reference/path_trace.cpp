#include "core/reference/path_trace.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/material/optics.h"
#include "core/math/rng.h"
#include "core/reference/direction_mixture.h"

namespace caustics {
namespace {

// Factor on radiance for one specular vertex of a path traced against the light, so that it
// carries what flux-conserving particles carry: with normals interpolated over a mesh the two
// differ by the cosines about the shading and the geometric normal (Veach 1997, sec. 5.3).
float flux_correction(const SurfacePoint& p, const Vec3& towards_receiver,
                      const Vec3& towards_light) {
    const float numerator =
        p.shading_normal.dot(towards_receiver) * p.geometric_normal.dot(towards_light);
    const float denominator =
        p.shading_normal.dot(towards_light) * p.geometric_normal.dot(towards_receiver);
    return denominator == 0 ? 0 : std::abs(numerator / denominator);
}

// Radiance arriving along a ray from L S+ by one random chain; 0 when its first surface is no
// caster.
Spectrum chain_radiance(const Scene& scene, Ray ray, int max_bounces, PathWavelength wavelength,
                        Rng& rng) {
    Spectrum weight = Spectrum::Ones();
    Spectrum result = black();
    const Spectrum* start_absorption = nullptr;
    for (int bounces = 0;; ++bounces) {
        const std::optional<SurfacePoint> hit = scene.intersect(ray);
        if (!hit) {
            // An absorbing medium without end leaves nothing.
            if (bounces > 0 && is_clear(start_absorption)) result += weight * scene.background();
            return result;
        }
        const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
        const Vec3 w = -ray.direction;
        weight *= segment_transmittance(
            start_absorption, medium_absorption(bsdf, hit->geometric_normal, w), hit->distance);
        const AreaLight* light = scene.area_light(hit->shape);
        if (light != nullptr && bounces > 0 && hit->geometric_normal.dot(w) > 0)
            result += weight * light->radiance;
        if (!is_caster(bsdf) || bounces == max_bounces) return result;
        wavelength.arrive_at(bsdf, rng, weight);
        const SpecularSplit split =
            split_specular(bsdf, hit->geometric_normal, hit->shading_normal, w, wavelength.nm);
        const float reflect_share = (split.reflected_weight * weight).mean() / weight.mean();
        const float refract_share = (split.refracted_weight * weight).mean() / weight.mean();
        const float u = rng.next();
        Vec3 next;
        if (u < reflect_share) {
            next = split.reflected;
            weight *= split.reflected_weight / reflect_share;
        } else if (u < reflect_share + refract_share) {
            next = split.refracted;
            weight *= split.refracted_weight / (refract_share * split.eta * split.eta);
        } else {
            return result;
        }
        weight *= flux_correction(*hit, w, next);
        if (weight.maxCoeff() <= 0) return result;
        start_absorption = medium_absorption(bsdf, hit->geometric_normal, next);
        ray = spawn_ray({hit->position, hit->geometric_normal, hit->offset}, next);
    }
}

class PathTrace : public CausticEstimator {
public:
    PathTrace(const Scene& scene, const PathTraceParams& params, const RunOptions& options)
        : scene_(scene),
          seed_(options.seed),
          max_bounces_(params.max_bounces),
          paths_per_point_(std::max(
              1, (params.spp + options.samples_per_pixel - 1) / options.samples_per_pixel)) {
        for (const std::uint32_t index : scene.casters())
            caster_bounds_.push_back(bounding_sphere(scene.shapes()[index]));
    }

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
        static const Bsdf lambert{};
        ReceiverPoint receiver = point;
        if (!with_bsdf) {
            // Irradiance needs no viewer and no material: cosine lobe about the true normal.
            receiver.bsdf = &lambert;
            receiver.shading_normal = receiver.wo = point.geometric_normal;
        }
        const DirectionMixture mixture(caster_bounds_, receiver);
        Rng rng(seed_, Stage::path_trace, point.id);
        SpectrumSum sum = SpectrumSum::Zero();
        SpectrumSum squares = SpectrumSum::Zero();
        for (int path = 0; path < paths_per_point_; ++path) {
            throw_if_interrupted();
            const SpectrumSum value = sample(receiver, mixture, with_bsdf, rng).cast<double>();
            sum += value;
            squares += value * value;
        }
        const double n = paths_per_point_;
        Estimate result{(sum / n).cast<float>(), black()};
        if (paths_per_point_ > 1)
            result.standard_error =
                ((squares / n - (sum / n).square()).max(0) / (n - 1)).sqrt().cast<float>();
        return result;
    }

    Spectrum sample(const ReceiverPoint& point, const DirectionMixture& mixture, bool with_bsdf,
                    Rng& rng) const {
        const std::optional<Vec3> wi = mixture.sample(rng);
        if (!wi) return black();
        const float cosine = point.geometric_normal.dot(*wi);
        if (cosine <= 0) return black();
        const Spectrum scattering =
            with_bsdf ? evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, *wi)
                      : Spectrum(Spectrum::Ones());
        if (is_black(scattering)) return black();
        const Ray ray = spawn_ray({point.position, point.geometric_normal, point.offset}, *wi);
        const float weight = cosine / mixture.pdf_w(*wi);
        return scattering * chain_radiance(scene_, ray, max_bounces_, {.nm = point.nm}, rng) *
               weight;
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
                   .effort = {"spp=64"}},
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

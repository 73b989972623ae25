#include "core/render/direct_light.h"

#include <cmath>

namespace caustics {
namespace {

SegmentEnd end_of(const ReceiverPoint& p) { return {p.position, p.geometric_normal, p.offset}; }

// f_r times the cosine of a direction on the lit side; 0 below the geometric surface.
Spectrum scattering(const ReceiverPoint& p, const Vec3& wi) {
    if (p.geometric_normal.dot(wi) <= 0) return black();
    return evaluate(*p.bsdf, p.uv, p.shading_normal, p.wo, wi) * p.shading_normal.dot(wi);
}

Spectrum from_point(const Scene& scene, const ReceiverPoint& p, const PointLight& light) {
    const Vec3 towards = light.position - p.position;
    const float distance2 = towards.squaredNorm();
    const Vec3 wi = towards / std::sqrt(distance2);
    const Spectrum f = scattering(p, wi) * light.intensity_along(-wi);
    if (is_black(f) || scene.occluded(end_of(p), SegmentEnd{light.position})) return black();
    return f / distance2;
}

Spectrum from_directional(const Scene& scene, const ReceiverPoint& p,
                          const DirectionalLight& light) {
    const Vec3 wi = -light.direction;
    const Spectrum f = scattering(p, wi);
    if (is_black(f) || scene.occluded_along(end_of(p), wi)) return black();
    return f * light.irradiance;
}

// Solid-angle density at the receiver of a point drawn uniformly by area on the light.
float light_pdf_w(const AreaLight& light, float distance2, float cos_light) {
    return distance2 / (cos_light * static_cast<float>(light.sampler.area()));
}

Spectrum by_light_sample(const Scene& scene, const ReceiverPoint& p, const AreaLight& light,
                         Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const auto sample = light.sampler.sample(scene.shapes()[light.shape], u0, u1);
    const Vec3 towards = sample.position - p.position;
    const float distance2 = towards.squaredNorm();
    if (distance2 == 0) return black();
    const Vec3 wi = towards / std::sqrt(distance2);
    const float cos_light = -sample.normal.dot(wi);
    const Spectrum f = scattering(p, wi);
    if (cos_light <= 0 || is_black(f)) return black();
    if (scene.occluded(end_of(p), {sample.position, sample.normal, sample.offset})) return black();
    const float pdf = light_pdf_w(light, distance2, cos_light);
    return f * light.radiance / (pdf + direction_pdf(*p.bsdf, p.shading_normal, p.wo, wi));
}

Spectrum by_bsdf_sample(const Scene& scene, const ReceiverPoint& p, Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const float u2 = rng.next();
    const auto wi = sample_direction(*p.bsdf, p.shading_normal, p.wo, u0, u1, u2);
    if (!wi) return black();
    const Spectrum f = scattering(p, *wi);
    if (is_black(f)) return black();
    const auto hit = scene.intersect(spawn_ray(end_of(p), *wi));
    if (!hit) return black();
    const AreaLight* light = scene.area_light(hit->shape);
    const float cos_light = -hit->geometric_normal.dot(*wi);
    if (light == nullptr || cos_light <= 0) return black();
    const float pdf = light_pdf_w(*light, hit->distance * hit->distance, cos_light);
    return f * light->radiance / (pdf + direction_pdf(*p.bsdf, p.shading_normal, p.wo, *wi));
}

}  // namespace

Spectrum direct_radiance(const Scene& scene, const ReceiverPoint& point, Rng& rng) {
    Spectrum sum = black();
    bool has_area_light = false;
    for (const Light& light : scene.lights()) {
        if (const auto* at_point = std::get_if<PointLight>(&light)) {
            sum += from_point(scene, point, *at_point);
        } else if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
            sum += from_directional(scene, point, *directional);
        } else {
            has_area_light = true;
            sum += by_light_sample(scene, point, std::get<AreaLight>(light), rng);
        }
    }
    if (has_area_light) sum += by_bsdf_sample(scene, point, rng);
    return sum;
}

}  // namespace caustics

#include "core/scene/light_media.h"

#include <algorithm>

#include "core/material/optics.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

// On the side of a surface's normal. Where no dielectric is seen from there (a lamp that faces down in a pool), the
// surfaces that are seen are asked for those that they see.
PlaceMedium medium_before(const Scene& scene, const SegmentEnd& point) {
    if (const Spectrum* const here = medium_at(scene, point)) return {here};
    PlaceMedium medium;
    constexpr std::uint32_t rays = 32;
    const Frame frame(point.geometric_normal);
    for (std::uint32_t i = 0; i < rays; ++i) {
        const float along = (static_cast<float>(i) + 0.5F) / rays;
        const Vec3 up = cosine_hemisphere(along, static_cast<float>(radical_inverse<2>(i, 0.25)));
        const Ray ray = spawn_ray(point, frame.to_world(up));
        const auto hit = scene.intersect(ray);
        if (!hit) continue;
        const bool front = hit->geometric_normal.dot(ray.direction) < 0;
        const Vec3 normal = front ? hit->geometric_normal : Vec3(-hit->geometric_normal);
        if (!medium.agrees_with(medium_at(scene, {hit->position, normal, hit->offset}))) break;
    }
    return medium;
}

// At points spread over the front of the surface.
PlaceMedium medium_over(const Scene& scene, const AreaLight& light) {
    PlaceMedium medium;
    constexpr std::uint32_t points = 16;
    for (std::uint32_t i = 0; i < points; ++i) {
        const float along = (static_cast<float>(i) + 0.5F) / points;
        const AreaSampler::Sample at = light.sampler.sample(
            scene.shapes()[light.shape], along, static_cast<float>(radical_inverse<2>(i, 0.25)));
        const PlaceMedium here = medium_before(scene, {at.position, at.normal, at.offset});
        if (here.ambiguous) return here;
        if (!medium.agrees_with(here.absorption)) break;
    }
    return medium;
}

PlaceMedium medium_of(const Scene& scene, const Light& light) {
    if (const auto* const area = std::get_if<AreaLight>(&light)) return medium_over(scene, *area);
    const auto point = point_of(light);
    return point && point->position ? medium_around(scene, *point->position) : PlaceMedium{};
}

}  // namespace

std::vector<PlaceMedium> light_media(const Scene& scene) {
    std::vector<PlaceMedium> media(scene.lights().size());
    if (absorbs_somewhere(scene))
        std::ranges::transform(scene.lights(), media.begin(),
                               [&](const Light& light) { return medium_of(scene, light); });
    return media;
}

bool absorbs_at_mirrors_or_lamps(const Scene& scene) {
    if (!absorbs_somewhere(scene)) return false;
    const auto is_mirror = [&](std::uint32_t caster) {
        return !std::holds_alternative<Dielectric>(scene.shapes()[caster].bsdf.model);
    };
    return std::ranges::any_of(scene.casters(), is_mirror) ||
           std::ranges::any_of(scene.light_media(), [](const PlaceMedium& medium) {
               return !is_clear(medium.absorption);
           });
}

}  // namespace caustics

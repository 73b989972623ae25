#include "core/scene/medium_finder.h"

#include <algorithm>
#include <cmath>

#include "core/material/optics.h"
#include "core/math/frame.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

// Evenly over the sphere, for all i < count: Fibonacci's lattice.
Vec3 direction(int i, int count) {
    const double golden_angle = pi_d * (3 - std::sqrt(5.0));
    const double z = 1 - (2 * i + 1.0) / count;
    const double across = std::sqrt(1 - z * z);
    return Vec3d(across * std::cos(i * golden_angle), across * std::sin(i * golden_angle), z)
        .cast<float>()
        .normalized();
}

bool absorbs(const Shape& shape) {
    const auto* const dielectric = std::get_if<Dielectric>(&shape.bsdf.model);
    return dielectric != nullptr &&
           !(is_black(dielectric->absorption) && is_black(dielectric->ext_absorption));
}

}  // namespace

bool absorbs_somewhere(const std::vector<Shape>& shapes) {
    return std::ranges::any_of(shapes, absorbs);
}

MediumFinder::MediumFinder(const std::vector<Shape>& shapes, const Intersector& intersector)
    : shapes_(shapes), intersector_(intersector), absorbs_(absorbs_somewhere(shapes)) {}

// What the dielectric that a ray meets first says of the side that it comes from; null: it meets none.
const Spectrum* MediumFinder::along(const Ray& ray) const {
    const auto hit = intersector_.intersect(ray);
    if (!hit) return nullptr;
    return medium_absorption(shapes_[hit->shape].bsdf, hit->geometric_normal, -ray.direction);
}

PlaceMedium MediumFinder::around(const Vec3& place) const {
    PlaceMedium medium;
    if (!absorbs_) return medium;
    constexpr int rays = 4096;
    for (int i = 0; i < rays; ++i)
        if (!medium.agrees_with(along({place, direction(i, rays)}))) break;
    return medium;
}

const Spectrum* MediumFinder::before(const SegmentEnd& point) const {
    if (!absorbs_) return nullptr;
    constexpr int rays = 256;
    const Frame frame(point.geometric_normal);
    for (int i = 0; i < rays; ++i) {
        // The half of the sphere's lattice above its equator.
        const Vec3 up = frame.to_world(direction(i, 2 * rays));
        if (const Spectrum* const here = along(spawn_ray(point, up))) return here;
    }
    return nullptr;
}

// Where no dielectric is seen from there (a lamp that faces down in a pool), the surfaces that are seen are asked for
// those that they see.
PlaceMedium MediumFinder::before_or_about(const SegmentEnd& point) const {
    if (const Spectrum* const here = before(point)) return {here};
    PlaceMedium medium;
    constexpr std::uint32_t rays = 32;
    const Frame frame(point.geometric_normal);
    for (std::uint32_t i = 0; i < rays; ++i) {
        const float along = (static_cast<float>(i) + 0.5F) / rays;
        const Vec3 up = cosine_hemisphere(along, static_cast<float>(radical_inverse<2>(i, 0.25)));
        const Ray ray = spawn_ray(point, frame.to_world(up));
        const auto hit = intersector_.intersect(ray);
        if (!hit) continue;
        const bool front = hit->geometric_normal.dot(ray.direction) < 0;
        const Vec3 normal = front ? hit->geometric_normal : Vec3(-hit->geometric_normal);
        if (!medium.agrees_with(before({hit->position, normal, hit->offset}))) break;
    }
    return medium;
}

// At points spread over the front of the surface.
PlaceMedium MediumFinder::over(const AreaLight& light) const {
    PlaceMedium medium;
    constexpr std::uint32_t points = 16;
    for (std::uint32_t i = 0; i < points; ++i) {
        const float along = (static_cast<float>(i) + 0.5F) / points;
        const AreaSampler::Sample at = light.sampler.sample(
            shapes_[light.shape], along, static_cast<float>(radical_inverse<2>(i, 0.25)));
        const PlaceMedium here = before_or_about({at.position, at.normal, at.offset});
        if (here.ambiguous) return here;
        if (!medium.agrees_with(here.absorption)) break;
    }
    return medium;
}

PlaceMedium MediumFinder::of(const Light& light) const {
    if (!absorbs_) return {};
    if (const auto* const area = std::get_if<AreaLight>(&light)) return over(*area);
    const auto point = point_of(light);
    return point && point->position ? around(*point->position) : PlaceMedium{};
}

}  // namespace caustics

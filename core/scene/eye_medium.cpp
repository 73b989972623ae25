#include "core/scene/eye_medium.h"

#include <algorithm>
#include <cmath>

#include "core/material/optics.h"
#include "core/math/frame.h"

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

// What the dielectric that a ray meets first says of the side that it comes from; null: it meets none.
const Spectrum* medium_along(const Scene& scene, const Ray& ray) {
    const auto hit = scene.intersect(ray);
    if (!hit) return nullptr;
    return medium_absorption(scene.shape_at(*hit).bsdf, hit->geometric_normal, -ray.direction);
}

}  // namespace

bool absorbs_somewhere(const Scene& scene) { return std::ranges::any_of(scene.shapes(), absorbs); }

PlaceMedium medium_around(const Scene& scene, const Vec3& place) {
    PlaceMedium medium;
    if (!absorbs_somewhere(scene)) return medium;
    constexpr int rays = 4096;
    for (int i = 0; i < rays; ++i)
        if (!medium.agrees_with(medium_along(scene, {place, direction(i, rays)}))) break;
    return medium;
}

EyeMedium eye_medium(const Scene& scene) {
    const PlaceMedium medium = medium_around(scene, scene.camera().position());
    return {medium.absorption != nullptr ? *medium.absorption : black(), medium.ambiguous};
}

const Spectrum* medium_at(const Scene& scene, const SegmentEnd& point) {
    if (!absorbs_somewhere(scene)) return nullptr;
    constexpr int rays = 256;
    const Frame frame(point.geometric_normal);
    for (int i = 0; i < rays; ++i) {
        // The half of the sphere's lattice above its equator.
        const Vec3 up = frame.to_world(direction(i, 2 * rays));
        if (const Spectrum* const here = medium_along(scene, spawn_ray(point, up))) return here;
    }
    return nullptr;
}

}  // namespace caustics

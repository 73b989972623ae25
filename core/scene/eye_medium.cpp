#include "core/scene/eye_medium.h"

#include <algorithm>
#include <cmath>

#include "core/material/optics.h"

namespace caustics {
namespace {

constexpr int rays = 4096;

// Evenly over the sphere: Fibonacci's lattice.
Vec3 direction(int i) {
    const double golden_angle = pi_d * (3 - std::sqrt(5.0));
    const double z = 1 - (2 * i + 1.0) / rays;
    const double across = std::sqrt(1 - z * z);
    return Vec3d(across * std::cos(i * golden_angle), across * std::sin(i * golden_angle), z)
        .cast<float>()
        .normalized();
}

bool absorbs_somewhere(const Shape& shape) {
    const auto* const dielectric = std::get_if<Dielectric>(&shape.bsdf.model);
    return dielectric != nullptr &&
           !(is_black(dielectric->absorption) && is_black(dielectric->ext_absorption));
}

}  // namespace

EyeMedium eye_medium(const Scene& scene) {
    EyeMedium medium;
    if (std::ranges::none_of(scene.shapes(), absorbs_somewhere)) return medium;
    const Vec3 eye = scene.camera().position();
    const Spectrum* found = nullptr;
    for (int i = 0; i < rays; ++i) {
        const Ray ray{eye, direction(i)};
        const auto hit = scene.intersect(ray);
        if (!hit) continue;
        const Spectrum* const here =
            medium_absorption(scene.shape_at(*hit).bsdf, hit->geometric_normal, -ray.direction);
        if (here == nullptr) continue;
        if (found == nullptr) found = here;
        if ((*here != *found).any()) return {black(), true};
    }
    if (found != nullptr) medium.absorption = *found;
    return medium;
}

}  // namespace caustics

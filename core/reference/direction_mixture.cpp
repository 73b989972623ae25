#include "core/reference/direction_mixture.h"

#include <algorithm>

namespace caustics {

std::vector<BoundingSphere> caster_bounds(const Scene& scene) {
    std::vector<BoundingSphere> bounds;
    for (const std::uint32_t index : scene.casters())
        bounds.push_back(bounding_sphere(scene.shapes()[index]));
    return bounds;
}

DirectionMixture::DirectionMixture(std::span<const BoundingSphere> casters,
                                   const ReceiverPoint& point)
    : point_(point) {
    for (const BoundingSphere& sphere : casters) {
        const Vec3 towards = sphere.centre - point.position;
        const float distance = towards.norm();
        const float sine = sphere.radius * (1 + 1e-5F) / distance;
        // Seen from inside its bounds a caster may lie in every direction.
        if (sine < 1) cones_.push_back(DirectionCone::from_sine(towards / distance, sine));
    }
}

std::optional<Vec3> DirectionMixture::sample(Rng& rng) const {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const float u2 = rng.next();
    if (cones_.empty() || u2 < 0.5F) {
        const float rest = cones_.empty() ? u2 : 2 * u2;
        return sample_direction(bsdf(), point_.shading_normal, point_.wo, u0, u1, rest);
    }
    const auto at = static_cast<std::size_t>((2 * u2 - 1) * static_cast<float>(cones_.size()));
    return cones_[std::min(at, cones_.size() - 1)].sample(u0, u1);
}

float DirectionMixture::pdf_w(const Vec3& wi) const {
    const float bsdf_pdf = direction_pdf(bsdf(), point_.shading_normal, point_.wo, wi);
    if (cones_.empty()) return bsdf_pdf;
    float cone_pdf = 0;
    for (const DirectionCone& cone : cones_)
        if (cone.contains(wi)) cone_pdf += static_cast<float>(1 / cone.solid_angle());
    return 0.5F * bsdf_pdf + 0.5F * cone_pdf / static_cast<float>(cones_.size());
}

}  // namespace caustics

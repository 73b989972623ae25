#include "core/scene/lights_on_casters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/surface_offset.h"

namespace caustics {
namespace {

// Half of the length of the probing rays, in roundings of the place.
constexpr float reach = 64;
// Surfaces at one place.
constexpr int most_surfaces = 8;
// Points asked of an area light, along each side of its square.
constexpr int side = 4;

class Probe {
public:
    /// Does not find the shape `own`, whose light it is: that shines from its front.
    Probe(const Scene& scene, std::uint32_t own) : scene_(scene), own_(own) {}

    // Any surface through the place crosses one of three lines through it at 35 degrees or more.
    std::optional<LightOnCaster> at(const Vec3& place) const {
        for (int axis = 0; axis < 3; ++axis)
            if (const auto found = along(place, Vec3::Unit(axis))) return found;
        return {};
    }

private:
    std::optional<LightOnCaster> along(const Vec3& place, const Vec3& direction) const {
        const float rounding = rounding_offset(place);
        const float length = 2 * reach * rounding;
        float gone = 0;
        for (int i = 0; i < most_surfaces && gone < length; ++i) {
            const Ray ray{place + (gone - reach * rounding) * direction, direction, length - gone};
            const std::optional<SurfacePoint> hit = scene_.intersect(ray);
            if (!hit) return {};
            const float height = std::abs(hit->geometric_normal.dot(hit->position - place));
            if (height <= rounding && hit->shape != own_ && is_caster(scene_.shape_at(*hit).bsdf))
                return LightOnCaster{place, hit->shape};
            gone += hit->distance + rounding;
        }
        return {};
    }

    const Scene& scene_;
    std::uint32_t own_;
};

constexpr std::uint32_t no_shape = ~0U;

std::uint32_t shape_of(const Light& light) {
    const auto* const area = std::get_if<AreaLight>(&light);
    return area == nullptr ? no_shape : area->shape;
}

std::vector<Vec3> places_of(const Scene& scene, const Light& light) {
    if (const auto point = point_of(light); point && point->position) return {*point->position};
    std::vector<Vec3> places;
    if (const auto* area = std::get_if<AreaLight>(&light))
        for (int i = 0; i < side * side; ++i)
            places.push_back(area->sampler
                                 .sample(scene.shapes()[area->shape],
                                         (static_cast<float>(i / side) + 0.5F) / side,
                                         (static_cast<float>(i % side) + 0.5F) / side)
                                 .position);
    return places;
}

}  // namespace

std::vector<LightOnCaster> lights_on_casters(const Scene& scene) {
    std::vector<LightOnCaster> all;
    for (const Light& light : scene.lights()) {
        const Probe probe(scene, shape_of(light));
        for (const Vec3& place : places_of(scene, light))
            if (const auto found = probe.at(place)) {
                all.push_back(*found);
                break;
            }
    }
    return all;
}

}  // namespace caustics

#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/material/optics.h"
#include "core/scene/intersector.h"
#include "core/scene/medium_finder.h"

namespace caustics {

Scene::Scene(SceneDesc desc)
    : shapes_(std::move(desc.shapes)),
      lights_(std::move(desc.lights)),
      light_of_shape_(shapes_.size(), -1),
      ambient_(desc.ambient),
      camera_(desc.camera),
      sampling_(desc.sampling),
      origin_(desc.origin) {
    // The order in a file changes nothing.
    std::ranges::stable_sort(lights_, {}, [](const Light& light) { return family_of(light); });
    for (const Light& light : lights_) background_ += background_of(light);
    for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
        const Shape& shape = shapes_[i];
        bounds_.extend(caustics::bounds(shape));
        if (is_caster(shape.bsdf)) casters_.push_back(i);
        if (!shape.radiance) continue;
        light_of_shape_[i] = static_cast<std::int32_t>(lights_.size());
        lights_.emplace_back(AreaLight{i, *shape.radiance, AreaSampler(shape)});
    }
    intersector_ = std::make_unique<const Intersector>(shapes_);
    const MediumFinder media(shapes_, *intersector_);
    for (const Light& light : lights_) light_media_.push_back(media.of(light));
}

Scene::~Scene() = default;

std::optional<SurfacePoint> Scene::intersect(const Ray& ray) const {
    return intersector_->intersect(ray);
}

void Scene::intersect_together(std::span<const Ray> rays,
                               std::span<std::optional<SurfacePoint>> hits) const {
    intersector_->intersect_together(rays, hits);
}

bool Scene::occluded(const SegmentEnd& from, const SegmentEnd& to) const {
    const Ray ray = segment_between(from, to);
    return ray.max_distance > 0 && intersector_->occluded(ray);
}

bool Scene::occluded_along(const SegmentEnd& from, const Vec3& direction) const {
    return intersector_->occluded(spawn_ray(from, direction));
}

PlaceMedium Scene::medium_around(const Vec3& place) const {
    return MediumFinder(shapes_, *intersector_).around(place);
}

const Spectrum* Scene::medium_before(const SegmentEnd& point) const {
    return MediumFinder(shapes_, *intersector_).before(point);
}

const AreaLight* Scene::area_light(std::uint32_t shape) const {
    const std::int32_t index = light_of_shape_[shape];
    return index < 0 ? nullptr : &std::get<AreaLight>(lights_[static_cast<std::size_t>(index)]);
}

const Spectrum* Scene::area_light_medium(std::uint32_t shape) const {
    const std::int32_t index = light_of_shape_[shape];
    return index < 0 ? nullptr : light_media_[static_cast<std::size_t>(index)].absorption;
}

float Scene::diameter() const { return bounds_.diagonal().norm(); }

Spectrum Scene::transmittance_along(const Ray& ray, const Spectrum* absorption) const {
    if (is_clear(absorption)) return Spectrum::Ones();
    if (std::isfinite(ray.max_distance)) return transmittance(*absorption, ray.max_distance);
    const float way_out = -distance_to_entry(bounds_, ray.origin, -ray.direction);
    return transmittance(*absorption, std::max(0.0F, way_out));
}

bool disperses(const Scene& scene) {
    return std::ranges::any_of(scene.shapes(),
                               [](const Shape& shape) { return is_dispersive(shape.bsdf); });
}

}  // namespace caustics

#include "core/scene/scene.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/scene/intersector.h"

namespace caustics {

Scene::Scene(SceneDesc desc)
    : shapes_(std::move(desc.shapes)),
      light_of_shape_(shapes_.size(), -1),
      ambient_(desc.ambient),
      camera_(desc.camera),
      sampling_(desc.sampling),
      origin_(desc.origin) {
    for (const PointLight& light : desc.point_lights) lights_.emplace_back(light);
    for (const DirectionalLight& light : desc.directional_lights) lights_.emplace_back(light);
    if (desc.constant_light) {
        background_ = desc.constant_light->radiance;
        lights_.emplace_back(*desc.constant_light);
    }
    for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
        const Shape& shape = shapes_[i];
        bounds_.extend(caustics::bounds(shape));
        if (is_caster(shape.bsdf)) casters_.push_back(i);
        if (!shape.radiance) continue;
        light_of_shape_[i] = static_cast<std::int32_t>(lights_.size());
        lights_.emplace_back(AreaLight{i, *shape.radiance, AreaSampler(shape)});
    }
    intersector_ = std::make_unique<const Intersector>(shapes_);
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

const AreaLight* Scene::area_light(std::uint32_t shape) const {
    const std::int32_t index = light_of_shape_[shape];
    return index < 0 ? nullptr : &std::get<AreaLight>(lights_[static_cast<std::size_t>(index)]);
}

float Scene::diameter() const { return bounds_.diagonal().norm(); }

bool disperses(const Scene& scene) {
    return std::ranges::any_of(scene.shapes(),
                               [](const Shape& shape) { return is_dispersive(shape.bsdf); });
}

float distance_to_entry(const Box& bounds, const Vec3& point, const Vec3& direction) {
    // Outwards by more than the rounding of the bounds, of a flat scene as well.
    const Vec3 low = bounds.min() - Vec3::Constant(0x1p-20F * bounds.min().cwiseAbs().maxCoeff());
    const Vec3 high = bounds.max() + Vec3::Constant(0x1p-20F * bounds.max().cwiseAbs().maxCoeff());
    float entry = -std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const float face = direction[axis] > 0 ? low[axis] : high[axis];
        entry = std::max(entry, (face - point[axis]) / direction[axis]);
    }
    return entry;
}

Vec3 offset_origin(const SegmentEnd& end, const Vec3& direction) {
    const float side = end.geometric_normal.dot(direction) < 0 ? -end.offset : end.offset;
    return end.position + side * end.geometric_normal;
}

Ray segment_between(const SegmentEnd& from, const SegmentEnd& to) {
    const Vec3 towards = to.position - from.position;
    Ray ray;
    ray.origin = offset_origin(from, towards);
    const Vec3 segment = offset_origin(to, -towards) - ray.origin;
    const float distance = segment.norm();
    // The far end is found from here, to some roundings of the distance: ending before it by more than
    // those, the ray does not meet the surface that it goes to.
    ray.max_distance = distance * (1 - 0x1p-19F);
    if (distance > 0) ray.direction = segment / distance;
    return ray;
}

Ray spawn_ray(const SegmentEnd& end, const Vec3& direction) {
    Ray ray;
    ray.origin = offset_origin(end, direction);
    ray.direction = direction;
    return ray;
}

}  // namespace caustics

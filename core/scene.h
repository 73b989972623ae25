#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/light.h"
#include "core/shape.h"

namespace caustics {

class Intersector;

struct Ray {
    Vec3 origin = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();  ///< unit
    float max_distance = std::numeric_limits<float>::infinity();
};

/// A point on a surface as a ray found it.
struct SurfacePoint {
    Vec3 position;
    Vec3 geometric_normal;  ///< unit, front side of the surface
    Vec3 shading_normal;    ///< unit, front side
    Vec2 uv;
    float distance;       ///< from the ray's origin [m]
    std::uint32_t shape;  ///< index into Scene::shapes
};

/// How the pixel's samples are placed (Mitsuba's `independent` and `stratified`; row C4).
struct PixelSampling {
    bool stratified = false;
    bool jitter = true;  ///< of stratified samples; false = cell centres
    int sample_count = 4;
};

/// The parsed scene: plain data, no acceleration structure.
struct SceneDesc {
    std::vector<Shape> shapes;
    std::vector<PointLight> point_lights;
    std::vector<DirectionalLight> directional_lights;
    Camera camera;
    PixelSampling sampling;
};

/// Surfaces, lights and camera with one intersector for every method. Immutable.
class Scene {
public:
    explicit Scene(SceneDesc desc);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    std::optional<SurfacePoint> intersect(const Ray& ray) const;
    /// Whether any surface lies between two points. Each end that lies on a surface is given with
    /// its geometric normal, or zero for a free point.
    bool occluded(const Vec3& from, const Vec3& from_normal, const Vec3& to,
                  const Vec3& to_normal) const;
    /// Whether any surface lies in a direction (unit) from a surface point.
    bool occluded(const Vec3& from, const Vec3& from_normal, const Vec3& direction) const;

    const std::vector<Shape>& shapes() const { return shapes_; }
    const Shape& shape_at(const SurfacePoint& p) const { return shapes_[p.shape]; }
    const std::vector<Light>& lights() const { return lights_; }
    /// The area light on a shape, or nullptr.
    const AreaLight* area_light(std::uint32_t shape) const;
    /// Indices of the shapes with a perfectly specular part.
    const std::vector<std::uint32_t>& casters() const { return casters_; }
    const Camera& camera() const { return camera_; }
    const PixelSampling& sampling() const { return sampling_; }
    const Box& bounds() const { return bounds_; }  ///< of the surfaces
    float diameter() const;                        ///< of the bounds [m]

private:
    std::vector<Shape> shapes_;
    std::vector<Light> lights_;
    std::vector<std::int32_t> light_of_shape_;
    std::vector<std::uint32_t> casters_;
    Camera camera_;
    PixelSampling sampling_;
    Box bounds_;
    std::unique_ptr<const Intersector> intersector_;
};

/// A ray that leaves a surface point along `direction` without meeting it again (the one offset
/// rule; see intersector.h).
Ray spawn_ray(const Vec3& position, const Vec3& geometric_normal, const Vec3& direction);

}  // namespace caustics

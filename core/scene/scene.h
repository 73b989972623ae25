#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/segment.h"
#include "core/geometry/shape.h"
#include "core/lights/light.h"
#include "core/scene/camera.h"
#include "core/scene/place_medium.h"

namespace caustics {

class Intersector;

/// How the pixel's samples are placed: Mitsuba's `independent` and `stratified` (row C4), and
/// `adaptive` (row J10), which doubles them while a pixel's standard error, as that of independent ones, exceeds a
/// share of its brightness, as the adaptive integrator of Mitsuba 0.6 does; they fill finer and finer grids
/// (CameraSamples). Samples that decide about more samples are used as well, so that an adaptive picture is slightly
/// biased.
struct PixelSampling {
    bool stratified = false;
    bool jitter = true;  ///< of stratified samples; false = cell centres
    int sample_count = 4;
    int max_sample_count = 0;  ///< of adaptive sampling; 0 = the same number everywhere
    float max_error = 0.05F;   ///< of adaptive sampling: allowed standard error / brightness
    /// So many specular events from the eye follow reflection and refraction both, however faint; from
    /// there on a part that is worth less than 5 % of the picture continues by roulette. Whitted's way, which
    /// leaves no specks on glass.
    int split_depth = 0;
    static constexpr int most_split_depth = 6;
};

/// The parsed scene: plain data, no acceleration structure. All coordinates are relative to `origin`,
/// so that floats resolve a small scene as well far from the world's origin as near it.
struct SceneDesc {
    Vec3d origin = Vec3d::Zero();  ///< of the scene's frame, in the world [m]
    std::vector<Shape> shapes;
    std::vector<Light> lights;   ///< but those of shapes
    Spectrum ambient = black();  ///< radiance of the light `ambient` [W m^-2 sr^-1]
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
    /// The same for up to `most_together` rays that lie near each other: they go through the tree side
    /// by side, which is faster. The hits are those of intersect() but for rounding: a ray that runs
    /// through an edge may end on the other triangle.
    static constexpr std::size_t most_together = most_rays_together;
    void intersect_together(std::span<const Ray> rays,
                            std::span<std::optional<SurfacePoint>> hits) const;
    /// Whether any surface lies between two ends.
    bool occluded(const SegmentEnd& from, const SegmentEnd& to) const;
    /// Whether any surface lies along a direction (unit).
    bool occluded_along(const SegmentEnd& from, const Vec3& direction) const;

    const std::vector<Shape>& shapes() const { return shapes_; }
    const Shape& shape_at(const SurfacePoint& p) const { return shapes_[p.shape]; }
    const std::vector<Light>& lights() const { return lights_; }
    /// What lights ask of the scene.
    Surroundings surroundings() const { return {shapes_, casters_, bounds_}; }
    /// The area light on a shape, or nullptr.
    const AreaLight* area_light(std::uint32_t shape) const;
    /// The medium about a place, and the absorption [1/m] before a point of a surface, as the dielectrics say that are
    /// seen from there (medium_finder.h).
    PlaceMedium medium_around(const Vec3& place) const;
    const Spectrum* medium_before(const SegmentEnd& point) const;
    /// The medium that each of the lights shines into.
    const std::vector<PlaceMedium>& light_media() const { return light_media_; }
    /// Absorption [1/m] before the area light on a shape; null: none is known, or there is no light.
    const Spectrum* area_light_medium(std::uint32_t shape) const;
    /// What a ray finds that meets nothing [W m^-2 sr^-1].
    const Spectrum& background() const { return background_; }
    /// Radiance that receivers are lit by from all sides without shadows, times their albedo; it is no
    /// light of lights(), and makes no caustics [W m^-2 sr^-1].
    const Spectrum& ambient() const { return ambient_; }
    /// Indices of the shapes with a perfectly specular part.
    const std::vector<std::uint32_t>& casters() const { return casters_; }
    const Camera& camera() const { return camera_; }
    const PixelSampling& sampling() const { return sampling_; }
    const Vec3d& origin() const { return origin_; }  ///< as SceneDesc::origin
    const Box& bounds() const { return bounds_; }    ///< of the surfaces
    float diameter() const;                          ///< of the bounds [m]
    /// What a medium (null: none) leaves of the light that comes along a ray which meets nothing: from the ray's end, or, where
    /// it has none, from the bounds, at which light from infinitely far away begins.
    Spectrum transmittance_along(const Ray& ray, const Spectrum* absorption) const;

private:
    std::vector<Shape> shapes_;
    std::vector<Light> lights_;
    std::vector<std::int32_t> light_of_shape_;
    std::vector<std::uint32_t> casters_;
    Spectrum background_ = black();
    Spectrum ambient_;
    Camera camera_;
    PixelSampling sampling_;
    Vec3d origin_;
    Box bounds_;
    std::unique_ptr<const Intersector> intersector_;
    std::vector<PlaceMedium> light_media_;
};

/// Whether light of different wavelengths goes different ways at some surface.
bool disperses(const Scene& scene);

}  // namespace caustics

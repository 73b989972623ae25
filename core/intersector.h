#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/scene.h"

namespace caustics {

/// Embree behind three calls: triangle meshes as they are, exact shapes as user geometry solved
/// in double. Robust mode; the tree is built by one thread, so that hits are the same everywhere.
class Intersector {
public:
    /// Keeps a reference to the shapes.
    explicit Intersector(const std::vector<Shape>& shapes);
    ~Intersector();
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;

    std::optional<SurfacePoint> intersect(const Ray& ray) const;
    bool occluded(const Ray& ray) const;

private:
    struct Embree;
    const std::vector<Shape>& shapes_;
    std::unique_ptr<Embree> embree_;
};

/// The one offset rule: moves a surface point off its surface to the side `direction` points to,
/// by a distance in units of the float spacing of its coordinates (after Wächter & Binder, "A Fast
/// and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, 2019).
Vec3 offset_origin(const Vec3& position, const Vec3& geometric_normal, const Vec3& direction);

}  // namespace caustics

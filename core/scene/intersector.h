#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/ray.h"
#include "core/geometry/shape.h"

namespace caustics {

/// Embree behind four calls: triangle meshes as they are, exact shapes as user geometry solved
/// in double. Robust mode; the tree is built by one thread, so that hits are the same everywhere.
class Intersector {
public:
    /// Keeps a reference to the shapes, which must not move.
    explicit Intersector(const std::vector<Shape>& shapes);
    explicit Intersector(std::vector<Shape>&&) = delete;  // it refers to them
    ~Intersector();
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;

    std::optional<SurfacePoint> intersect(const Ray& ray) const;
    /// As Scene::intersect_together.
    void intersect_together(std::span<const Ray> rays,
                            std::span<std::optional<SurfacePoint>> hits) const;
    bool occluded(const Ray& ray) const;

private:
    struct Embree;
    struct Arrival;
    void fill(const Arrival& arrival, SurfacePoint& point) const;

    std::unique_ptr<Embree> embree_;
};

}  // namespace caustics

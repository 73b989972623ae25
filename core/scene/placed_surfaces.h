#pragma once

#include <optional>
#include <vector>

#include "core/geometry/exact_shape.h"
#include "core/geometry/ray.h"
#include "core/geometry/shape.h"

namespace caustics {

/// Shapes as an intersector keeps them: what it asks on the way of a ray, and the point that it found.

/// An exact shape with its world -> local map.
class PlacedExact {
public:
    explicit PlacedExact(const Shape& shape)
        : shape_(&shape),
          to_local_(shape.to_world.inverse()),
          least_offset_(caustics::least_offset(shape)) {}

    const Shape& shape() const { return *shape_; }
    std::optional<ExactHit> intersect(const Vec3& origin, const Vec3& direction, float t_min,
                                      float t_max) const;
    /// All of the point but its distance and the number of its shape.
    void fill(const Vec3d& local, SurfacePoint& point) const;
    /// The point where a ray meets this shape, but for the number of its shape.
    std::optional<SurfacePoint> meet(const Ray& ray) const;

private:
    const Shape* shape_;
    Transform to_local_;
    float least_offset_;
};

/// A mesh with its vertices in one piece.
class PlacedMesh {
public:
    /// In half a cache line. Embree reads the positions where they lie; it may read 16 bytes from each.
    struct Vertex {
        Vec3 position;
        float u;
        Vec3 normal;
        float v;
    };
    static_assert(sizeof(Vertex) == 32);

    explicit PlacedMesh(const Shape& shape);

    const std::vector<Vertex>& vertices() const { return vertices_; }
    const TriangleMesh& mesh() const { return shape_->mesh; }
    /// As PlacedExact::fill, of a triangle at Embree's u and v.
    void fill(std::uint32_t triangle, float u, float v, SurfacePoint& point) const;

private:
    const Shape* shape_;
    std::vector<Vertex> vertices_;
    bool smooth_;  ///< has normals
    bool mapped_;  ///< has texture coordinates
};

}  // namespace caustics

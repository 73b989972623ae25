#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/exact_shapes/exact_kinds.h"
#include "core/material/bsdf.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"
#include "core/mesh/mesh.h"

namespace caustics {

/// A shape as the scene file says it, ready to be intersected.
struct Shape {
    std::string name;  ///< its key in the scene file, for messages
    Primitive primitive = Primitive::rectangle;
    SineHeightfield field;  ///< of a heightfield
    TriangleMesh mesh;      ///< of a mesh: the scene's frame, flips and to_world applied
    Transform to_world = Transform::Identity();  ///< of an exact shape: to the scene's frame
    bool flip_normals = false;                   ///< of an exact shape
    bool is_of_file = false;                     ///< a mesh of an obj or ply file
    bool is_oriented = false;  ///< such a mesh that `orient` turned (mesh_doctor.h)
    Bsdf bsdf;
    std::optional<Spectrum> radiance;  ///< emitted from the front side [W m^-2 sr^-1]
};

/// Calls `ask` with the kind (exact_kinds.h) of an exact shape. Not for meshes.
template <class Ask>
decltype(auto) ask_exact(const Shape& shape, const Ask& ask) {
    return ask_kind(shape.primitive, shape.field, ask);
}

/// Bounds in the shape's own frame: that of a mesh's positions.
Eigen::AlignedBox3d local_bounds(const Shape& shape);
/// Bounds in the scene's frame.
Box bounds(const Shape& shape);
/// A sphere that holds a shape or points, in the world's frame; not always the smallest.
struct BoundingSphere {
    Vec3 centre = Vec3::Zero();
    float radius = 0;
};
BoundingSphere bounding_sphere(const Shape& shape);
BoundingSphere bounding_sphere(std::span<const Vec3> points);
/// Points whose convex hull contains the shape: a mesh's vertices, the corners of an exact shape's
/// local bounds, which are put into `corners`.
std::span<const Vec3> hull_points(const Shape& shape, std::vector<Vec3>& corners);
/// Number of triangles; 0 for an exact shape.
std::size_t triangle_count(const Shape& shape);

/// The least offset of rays that leave an exact shape: covers the
/// roundings of its solution in double [m].
float least_offset(const Shape& shape);

/// Area sampling of emitters. Not for an exact heightfield.
class AreaSampler {
public:
    explicit AreaSampler(const Shape& shape);
    double area() const { return area_; }  ///< [m^2]

    struct Sample {
        Vec3 position;
        Vec3 normal;   ///< unit geometric normal, front side
        float offset;  ///< how far off the surface a ray starts that leaves the point [m]
    };
    /// Uniform by area, pdf_a = 1 / area().
    Sample sample(const Shape& shape, float u0, float u1) const;

private:
    double area_ = 0;
    float least_offset_ = 0;          ///< of an exact shape
    std::vector<double> cumulative_;  ///< of the triangles' areas, normalised
};

}  // namespace caustics

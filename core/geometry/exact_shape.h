#pragma once

#include <optional>

#include "core/geometry/shape.h"

namespace caustics {

/// Ray o + t d (d need not be unit) against the shape for t in (t_min, t_max), in its local frame. Nothing
/// for meshes.
std::optional<ExactHit> intersect_exact(const Shape& shape, const Vec3d& o, const Vec3d& d,
                                        double t_min, double t_max);

/// Whether it is an exact shape that lies in a plane; false for meshes.
bool exact_is_flat(const Shape& shape);
/// Unit normal of the front side in the local frame, without `flip_normals`.
Vec3d exact_normal(const Shape& shape, const Vec3d& local);
/// The point of the shape beside one near it.
Vec3d exact_onto(const Shape& shape, const Vec3d& local);
/// Derivative of exact_onto() at a point near the shape along a way.
Vec3d exact_onto_change(const Shape& shape, const Vec3d& local, const Vec3d& way);
/// Derivative of exact_normal() at a point of the shape along a way on it.
Vec3d exact_normal_change(const Shape& shape, const Vec3d& on, const Vec3d& way);
/// Texture coordinates as Mitsuba's.
Vec2 exact_uv(const Shape& shape, const Vec3d& local);
/// World area of the surface per area of texture coordinates, |dP/du x dP/dv| [m^2].
double exact_area_element(const Shape& shape, const Vec2d& uv);

}  // namespace caustics

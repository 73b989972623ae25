#pragma once

#include <optional>

#include "core/geometry/shape.h"

namespace caustics {

/// The first point of an exact shape along a ray, in the shape's local frame, solved in double.
struct ExactHit {
    double distance;  ///< ray parameter, the same in the local and the world frame
    Vec3d local;      ///< the point, on the shape to rounding
};

/// Ray o + t d (d need not be unit) against the shape for t in (t_min, t_max). Not for meshes.
std::optional<ExactHit> intersect_exact(const Shape& shape, const Vec3d& o, const Vec3d& d,
                                        double t_min, double t_max);

/// Unit normal of the front side in the local frame, without `flip_normals`.
Vec3d exact_normal(const Shape& shape, const Vec3d& local);
/// Texture coordinates as Mitsuba's.
Vec2 exact_uv(const Shape& shape, const Vec3d& local);
/// World area of the surface per area of texture coordinates, |dP/du x dP/dv| [m^2].
double exact_area_element(const Shape& shape, const Vec2d& uv);

}  // namespace caustics

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/math/vec.h"

namespace caustics {

struct Ray {
    Vec3 origin = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();  ///< unit
    float max_distance = std::numeric_limits<float>::infinity();
};

/// How many rays an intersector follows side by side.
inline constexpr std::size_t most_rays_together = 16;

/// A point on a surface as a ray found it.
struct SurfacePoint {
    Vec3 position = Vec3::Zero();
    Vec3 geometric_normal = Vec3::Zero();  ///< unit, front side of the surface
    Vec3 shading_normal = Vec3::Zero();    ///< unit, front side
    Vec2 uv = Vec2::Zero();
    float distance = 0;          ///< from the ray's origin [m]
    float offset = 0;            ///< how far off the surface a ray starts that leaves the point [m]
    std::uint32_t shape = 0;     ///< index into Scene::shapes
    std::uint32_t triangle = 0;  ///< index into the shape's mesh; 0 on an exact shape
};

}  // namespace caustics

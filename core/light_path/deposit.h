#pragma once

#include <cstdint>

#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics {

/// A particle's arrival on a receiver; of caustic paths, after at least one specular event.
struct Deposit {
    Vec3 position = Vec3::Zero();
    Vec3 geometric_normal = Vec3::Zero();  ///< unit, on the side of arrival
    Vec3 shading_normal = Vec3::Zero();    ///< unit, on the side of arrival
    Vec3 wi = Vec3::Zero();  ///< unit, away from the surface, where the particle came from
    Vec2 uv = Vec2::Zero();
    float offset = 0;  ///< as SurfacePoint::offset
    Spectrum flux = black();
    std::uint32_t shape = 0;
    int bounces = 0;          ///< specular ones since the light or the last receiver
    int diffuse_bounces = 0;  ///< diffuse reflections before it
    bool front = true;        ///< whether it arrived on the front side of the surface
};

}  // namespace caustics

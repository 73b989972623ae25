#pragma once

#include "core/math/rng.h"
#include "core/math/sampling.h"

namespace caustics::support {

/// Unit, even over the sphere.
inline Vec3 random_direction(Rng& rng) {
    const float u0 = rng.next();
    return uniform_cap(2, u0, rng.next()).normalized();
}

}  // namespace caustics::support

#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/shape.h"

namespace caustics {

/// What lights ask of a scene: its surfaces.
struct Surroundings {
    std::span<const Shape> shapes;
    std::span<const std::uint32_t>
        casters;              ///< indices of the shapes with a perfectly specular part
    Box bounds;               ///< of all shapes
    bool everywhere = false;  ///< whether light is aimed at all of them, not at the casters alone
};

}  // namespace caustics

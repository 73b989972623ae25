#pragma once

#include "tests/support/build_scene.h"

namespace caustics::support {

/// Parallel light through a ball of glass, whose focus lies before a mirror ball that sends it down to the floor at z = -3:
/// three events, and one of light that passes beside the glass.
inline SceneDesc ball_before_mirror() {
    SceneDesc desc;
    desc.shapes = {horizontal("floor", -3, 4, true, diffuse(0.5F)),
                   sphere("glass", {-2, 0, 0}, 0.5, glass(1.5F)),
                   sphere("mirror", {0.2, 0, 0.6}, 1, mirror())};
    desc.lights = {directional_light(Vec3d::UnitX(), 1)};
    return desc;
}

}  // namespace caustics::support

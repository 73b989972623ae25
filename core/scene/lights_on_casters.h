#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace caustics {

/// A light with a place that lies on a surface.
struct LightOnCaster {
    Vec3 position;         ///< of the light, or a point of it [m]
    std::uint32_t caster;  ///< index into Scene::shapes
};

/// Point and spot lights, and parts of area lights, that lie on a caster, not the light itself, to the rounding of their
/// coordinates: at most one a light. On which side of the surface such a light is nobody can say, and the two sides' light differs as day
/// and night: just off a mirror's front half of it is reflected, at its back none; just above water most of it enters,
/// just below only what is not reflected totally leaves. A light that starts on the surface itself never meets it.
/// Asks for a few rays a light, however large the meshes are.
std::vector<LightOnCaster> lights_on_casters(const Scene& scene);

}  // namespace caustics

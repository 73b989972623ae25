#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/light_sample.h"

namespace caustics::beamtree {

/// A rectangle before a light sample (for a directional light across its direction) through which its rays go that may
/// meet one caster first. Its points are corner + x * sides[0] + y * sides[1], with x and y from 0 to 1.
struct LightPatch {
    std::uint32_t light = 0;   ///< index of the sample
    std::uint32_t caster = 0;  ///< index into Scene::shapes
    Vec3d corner = Vec3d::Zero();
    std::array<Vec3d, 2> sides = {Vec3d::Zero(), Vec3d::Zero()};
    double watts = 0;  ///< that go through it, as some of its places tell
};

/// A ray through a point of a patch.
struct PatchRay {
    Vec3d direction;  ///< unit
    /// The flux through a small area of the patch's plane is the sample's strength times this times the area: solid angle over
    /// area [1/m^2], or 1 for a directional light.
    double measure;
};
PatchRay ray_through(const LightSample& light, const LightPatch& patch, const Vec3d& point);

/// The patches of all samples and casters, samples outermost. A caster that a light is beside or inside has up to six.
std::vector<LightPatch> light_patches(const Scene& scene, std::span<const LightSample> lights);

}  // namespace caustics::beamtree

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/light_sample.h"
#include "beamtree/pencils/caster_view.h"

namespace caustics::beamtree {

/// The rays of a light sample that may meet one caster first: those through a rectangle before the sample (for a directional
/// light across its direction), or of an area light those from each of its places through the view of the caster from there.
struct LightPatch {
    std::uint32_t light = 0;   ///< index of the sample
    std::uint32_t caster = 0;  ///< index into Scene::shapes
    ViewRectangle rectangle = {};
    CasterBounds bounds = {};  ///< where the light is an area light
    double turn = 0;           ///< of the views there
    double watts = 0;          ///< that go through it, as some of its places tell
};

/// A ray through a point of a rectangle.
struct PatchRay {
    Vec3d direction;  ///< unit
    /// Flux through a small area of the rectangle, over that area and the light's strength: solid angle per area [1/m^2],
    /// or 1 for a directional light.
    double measure;
};
PatchRay ray_through(const LightSample& light, const ViewRectangle& rectangle, const Vec3d& point);

/// The sample at another place of its area light, by two numbers from 0 to 1.
LightSample place_on_lamp(const Scene& scene, const LightSample& light, double u, double v);
/// Makes each sample of an area light stand for all of it.
std::vector<LightSample> whole_lamps(const Scene& scene, std::vector<LightSample> lights);

/// The patches of all samples and casters, samples outermost. A caster that a point light is beside or inside has up to six.
std::vector<LightPatch> light_patches(const Scene& scene, std::span<const LightSample> lights);

}  // namespace caustics::beamtree

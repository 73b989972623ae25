#pragma once

#include <vector>

#include "core/math/rng.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// A point that stands for a part of an area light.
struct AreaLightPoint {
    Vec3 position;
    Vec3 normal;   ///< unit, front side
    float offset;  ///< as AreaSampler::Sample::offset
    double area;   ///< of the part [m^2]
};

/// At most `count` points in place of an area light, as the casters see it.
///
/// A flat exact shape has a rank-1 lattice, each point for an even part. Of any other shape they are drawn by
/// recombine() from thousands of points all over it, of which those go first that shine into no caster's box. The
/// parts' expectations are the lamp's own areas, so that on average the casters' light is right, at any count; and the
/// light that is sent into the boxes, times harmonics of the side of the lamp that sends it, is that of the thousands:
/// up to degree 3 with 16 points, with more of them so for each of several compact parts of the lamp.
std::vector<AreaLightPoint> area_light_points(const Scene& scene, const AreaLight& light, int count,
                                              Rng rng);

}  // namespace caustics::beamtree

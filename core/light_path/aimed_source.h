#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/frame.h"
#include "core/math/sampling.h"
#include "core/math/spectrum.h"
#include "core/scene/scene.h"

namespace caustics {

struct AimedCone {
    DirectionCone cone;
    Frame frame{Vec3::UnitZ()};  ///< round the cone's axis
};

struct AimedDisc {
    Vec3 centre;
    float radius = 0;
};

/// A light, or a piece of a flat area light, with the regions that together hold all its rays to
/// the casters. The regions may overlap.
struct AimedSource {
    std::uint32_t light = 0;
    Spectrum power = black();      ///< into all regions, overlaps counted again and again [W]
    std::vector<AimedCone> cones;  ///< of directions: point and area lights
    /// Across a directional light, or any direction of a constant one.
    std::vector<AimedDisc> discs;
    std::vector<double> cumulative;  ///< of the regions' measures, normalised
    Frame across{Vec3::UnitZ()};     ///< round a directional light's direction
    float max_cosine = 1;            ///< area lights: bound of the cosine over the cones
    Vec2 low = Vec2::Zero();         ///< area lights: this piece's numbers of AreaSampler::sample
    Vec2 high = Vec2::Ones();
    /// A sphere that shines outwards: seen along a direction it is an even disc, without thinning.
    std::optional<BoundingSphere> facing_sphere;
};

/// The sources of a scene that send any power towards its casters.
std::vector<AimedSource> aimed_sources(const Scene& scene);

}  // namespace caustics

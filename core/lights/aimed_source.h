#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/box_tree.h"
#include "core/geometry/segment.h"
#include "core/lights/surroundings.h"
#include "core/math/frame.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "core/math/spectrum.h"

namespace caustics {

struct AimedCone {
    DirectionCone cone;
    Frame frame{Vec3::UnitZ()};  ///< round the cone's axis
};

struct AimedDisc {
    Vec3 centre;
    float radius = 0;
};

struct AimedSphere {
    BoundingSphere sphere;
    float widest = 0;  ///< DirectionCone::one_minus_cos from the nearest place that rays start from
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
    /// Boxes of the regions: of a cone's unit vectors, or of the sphere that a disc is of. Empty for one region.
    BoxTree boxes;
    Frame across{Vec3::UnitZ()};  ///< round a directional light's direction
    float max_cosine = 1;         ///< area lights: bound of the cosine over the cones
    Vec2 low = Vec2::Zero();      ///< area lights: this piece's numbers of AreaSampler::sample
    Vec2 high = Vec2::Ones();
    /// Bounding spheres of the casters, if directions are sampled from the start of each ray: in the cone that just holds the
    /// sphere. `cones` then bound the cones of all starts. Otherwise empty.
    std::vector<AimedSphere> targets;
    /// A sphere that shines outwards: seen along a direction it is an even disc, without thinning.
    std::optional<BoundingSphere> facing_sphere;
};

/// The sources of a light that has one, without a copy of its regions.
inline std::vector<AimedSource> alone(AimedSource source) {
    std::vector<AimedSource> sources;
    sources.push_back(std::move(source));
    return sources;
}

/// What a random point of the unit square is mapped to: a region of a source, and a place in it.
struct AimedSample {
    std::uint32_t region = 0;
    Vec2 disc = Vec2::Zero();        ///< of the unit disc, where the region is a disc
    Vec3 direction = Vec3::UnitZ();  ///< where it is a cone
    /// Where the source has targets: the place that the ray starts from, and DirectionCone::one_minus_cos from there.
    SegmentEnd start = {};
    float width = 0;
};

/// Fills a source's cones from a sphere to all casters; returns their solid angle [sr].
double aim_cones(const Surroundings& scene, const BoundingSphere& from, AimedSource& source);
/// Fills its discs round all casters; returns their area [m^2].
double aim_discs(const Surroundings& scene, AimedSource& source);

/// The cone that holds a sphere's directions from a place outside of it.
DirectionCone cone_from(const Vec3& place, const BoundingSphere& sphere);
/// Fills a source's targets, and the cones that hold them, from the places of a shape to all casters; returns the targets' solid
/// angle from the nearest places [sr]. Nothing where a caster's sphere may reach the shape.
std::optional<double> aim_spheres(const Surroundings& scene, const Shape& from,
                                  AimedSource& source);

/// How many regions of a source hold a sample, its own among them, and how many boxes were tested to find them.
struct Overlap {
    int holding = 1;
    int boxes_tested = 0;
};
/// Cones that hold a sample's direction.
Overlap cones_that_hold(const AimedSource& source, const AimedSample& sample);
/// Discs across a direction that hold a point of the sample's disc.
Overlap discs_that_hold(const AimedSource& source, const AimedSample& sample, const Vec3& point,
                        const Vec3& along);

/// Cones from a sample's start to targets that hold its direction.
Overlap targets_that_hold(const AimedSource& source, const AimedSample& sample);

/// Whether a sample of a cone is one of the union of all: thinned by the number of those that hold it.
bool kept_in_union(const AimedSource& source, const AimedSample& sample, Rng& rng);
/// The ray through a point of a disc across a direction from far away, thinned likewise.
std::optional<Ray> through_disc(const Surroundings& scene, const AimedSource& source,
                                const AimedSample& sample, const Frame& across, Rng& rng);

DirectionCone cone_of_half_angle(const Vec3d& axis, double half_angle);
/// Points of a shape's own frame in the scene's.
std::vector<Vec3> to_world(const Shape& shape, const std::vector<Vec3d>& local);

}  // namespace caustics

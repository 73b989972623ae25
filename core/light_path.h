#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/rng.h"
#include "core/sampling.h"
#include "core/scene.h"
#include "core/spectrum.h"

namespace caustics {

/// A particle that leaves a light, carrying flux [W] x emitted particles: divide by their number.
struct LightParticle {
    Ray ray;
    Spectrum flux = black();
};

/// A particle's arrival on a receiver after at least one specular event.
struct Deposit {
    Vec3 position;
    Vec3 geometric_normal;  ///< unit, on the side of arrival
    Vec3 shading_normal;    ///< unit, on the side of arrival
    Vec3 wi;                ///< unit, away from the surface, where the particle came from
    Vec2 uv;
    float offset = 0;  ///< as SurfacePoint::offset
    Spectrum flux = black();
    std::uint32_t shape = 0;
    int bounces = 0;
};

/// What became of emitted particles; the ends (missed to stored) add up to `aimed`.
struct LightPathCounts {
    std::uint64_t emitted = 0;   ///< drawn, including those thinned out at the light
    std::uint64_t aimed = 0;     ///< sent on their way
    std::uint64_t missed = 0;    ///< met no caster first
    std::uint64_t escaped = 0;   ///< left the scene after a caster
    std::uint64_t absorbed = 0;  ///< ended on a mirror, a black side, or a dropped shading normal
    std::uint64_t depth_limited = 0;
    std::uint64_t stored = 0;

    void add(const LightPathCounts& other);
    void add_to(Counters& counters) const;
};

/// Emission aimed at the casters, with equal-power particles over all lights: lights are chosen in
/// proportion to their aimed power; within a light directions (or points of a directional light's
/// front) are uniform over the union of the casters' bounds as seen from the light, a region seen
/// through several bounds counted once by thinning; the cosine of an area light is thinned too.
/// Rows J2 of [J96], equal power of [C11].
class AimedEmission {
public:
    explicit AimedEmission(const Scene& scene);

    /// The next particle, or empty when thinning dropped it (it still counts as emitted).
    std::optional<LightParticle> emit(Rng& rng) const;
    /// Sum over lights of the power sent into the aimed sets, before thinning [W].
    Spectrum total_power() const;
    /// No light or no caster, or they cannot see each other.
    bool empty() const { return sources_.empty(); }

private:
    struct Disc {
        Vec3 centre;
        float radius;
    };
    struct Source {
        std::uint32_t light = 0;
        Spectrum power = black();          ///< of the whole aimed measure [W]
        double share = 0;                  ///< probability of this light
        std::vector<DirectionCone> cones;  ///< point and area lights
        std::vector<Disc> discs;           ///< directional lights, on a plane before the scene
        std::vector<double> cumulative;    ///< of their measures, normalised
        float max_cosine = 1;              ///< area lights: bound of the cosine over the cones
    };
    double aim_cones(Source& source, const BoundingSphere& from, const Shape* emitter);
    double aim_discs(Source& source);
    static std::optional<Vec3> direction_in_union(const Source&, Rng&);
    static std::optional<Ray> emit_point(const Source&, const PointLight&, Rng&);
    std::optional<Ray> emit_area(const Source&, const AreaLight&, Rng&) const;
    std::optional<Ray> emit_directional(const Source&, const DirectionalLight&, Rng&) const;

    const Scene& scene_;
    std::vector<Source> sources_;
    std::vector<double> cumulative_;  ///< of the sources' shares
};

/// Follows a particle through specular surfaces, reflection or refraction decided by Russian
/// roulette whose probabilities weigh the channels, to its first receiver. At most `max_bounces`
/// specular events. Row J3, J9.
std::optional<Deposit> trace_light_path(const Scene& scene, const LightParticle& particle,
                                        int max_bounces, Rng& rng, LightPathCounts& counts);

}  // namespace caustics

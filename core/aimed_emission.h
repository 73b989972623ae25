#pragma once

#include <optional>
#include <vector>

#include "core/aimed_source.h"
#include "core/light_path.h"
#include "core/rng.h"
#include "core/scene.h"

namespace caustics {

/// Emission aimed at the casters, with equal-power particles over all lights: lights (and the
/// pieces of large ones) are chosen in proportion to their aimed power; within one, directions (or
/// points of a directional light's front) are uniform over the union of the casters' bounds as
/// seen from it, a region seen through several bounds counted once by thinning; the cosine of a
/// flat or a mesh light is thinned too. Rows J2 of [J96], equal power of [C11].
class AimedEmission {
public:
    explicit AimedEmission(const Scene& scene);

    /// The particle for a point of the unit square, or empty when thinning dropped it (it still
    /// counts as emitted). Uniform points make uniform particles: x picks the light and the region,
    /// its rest and y the direction, so that a stratified square makes stratified particles. All
    /// other numbers come from `rng`.
    std::optional<LightParticle> emit(const Vec2d& point, Rng& rng) const;
    /// The same for a random point.
    std::optional<LightParticle> emit(Rng& rng) const;
    /// Sum over lights of the power sent into the aimed sets, before thinning [W].
    Spectrum total_power() const;
    /// No light or no caster, or they cannot see each other.
    bool empty() const { return sources_.empty(); }

private:
    std::optional<Ray> emit_directional(const AimedSource&, std::size_t disc, const Vec2& at,
                                        Rng&) const;
    std::optional<Ray> emit_area(const AimedSource&, const Vec3& direction, Rng&) const;

    const Scene& scene_;
    std::vector<AimedSource> sources_;
    std::vector<double> cumulative_;  ///< of the sources' shares
    std::vector<Spectrum> flux_;      ///< of each source's particles
};

}  // namespace caustics

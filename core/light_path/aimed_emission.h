#pragma once

#include <optional>
#include <vector>

#include "core/light_path/emission_samples.h"
#include "core/light_path/light_path.h"
#include "core/math/rng.h"
#include "core/scene/scene.h"

namespace caustics {

/// What particles are sent towards.
enum class Aim {
    casters,
    everywhere  ///< all surfaces, through one sphere round the scene
};

/// Emission aimed at the casters, with equal-power particles over all lights: lights (and the
/// pieces of large ones) are chosen in proportion to their aimed power; within one, directions (or
/// points of a directional light's front) are uniform over the union of the casters' bounds as
/// seen from it, a region seen through several bounds counted once by thinning; the cosine of a
/// flat or a mesh light is thinned too. Rows J2 of [J96], equal power of [C11].
class AimedEmission {
public:
    /// Paths side by side are emitted by the kernels of `isa`; all of them give the same particles.
    explicit AimedEmission(const Scene& scene, Isa isa = Isa::plain, Aim where = Aim::casters);
    /// Of one light of the scene alone.
    AimedEmission(const Scene& scene, Isa isa, Aim where, std::uint32_t light);

    /// The particle for a random point of the unit square, or empty when thinning dropped it (it still
    /// counts as emitted).
    std::optional<LightParticle> emit(Rng& rng) const;
    /// The same for many paths side by side: appends those whose particles set out. Uniform points
    /// make uniform particles: x picks the light and the region, its rest and y the direction, so
    /// that a stratified square makes stratified particles. All other numbers come from the paths'
    /// streams.
    void emit(const EmissionSamples& samples, std::vector<LightPathStart>& starts) const;
    const EmissionKernels& kernels() const { return kernels_; }
    /// Sum over lights of the power sent into the aimed sets, before thinning [W].
    Spectrum total_power() const;
    /// Of the channel that is served worst, the share of particles with which it would be as noisy if they carried it
    /// evenly: 1 where all lights have one colour, near 0 where the only light of a colour is far weaker than others.
    double least_carried() const;
    /// True if a light that shines there is larger than a point or a direction.
    bool has_extent() const;
    /// No light or no caster, or they cannot see each other.
    bool empty() const { return sources_.empty(); }

private:
    AimedEmission(const Scene& scene, Isa isa, Aim where, std::span<const Light> lights,
                  std::uint32_t first_light);

    EmissionCone cone_at_start(std::uint32_t source, std::uint32_t cone, Rng& rng,
                               SegmentEnd& start) const;
    std::uint32_t choose(double& x, std::uint32_t& cone) const;
    /// `cone` is a region's number among those of all sources.
    std::optional<LightParticle> send(std::uint32_t source, std::uint32_t cone, AimedSample sample,
                                      Rng& rng) const;

    const Scene& scene_;
    Surroundings surroundings_;
    const EmissionKernels& kernels_;
    std::vector<AimedSource> sources_;       ///< those that send any power towards the casters
    std::vector<double> cumulative_;         ///< of the sources' shares
    std::vector<Spectrum> flux_;             ///< of each source's particles
    std::vector<EmissionCone> cones_;        ///< of all sources' regions; those of discs are empty
    std::vector<std::uint32_t> first_cone_;  ///< of each source
    bool has_targets_ = false;               ///< any of them
};

}  // namespace caustics

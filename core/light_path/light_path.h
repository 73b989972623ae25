#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/light_ledger.h"
#include "core/light_path/bounce_limit.h"
#include "core/light_path/deposit.h"
#include "core/math/rng.h"
#include "core/math/spectrum.h"
#include "core/scene/scene.h"

namespace caustics {

/// A particle that leaves a light, carrying flux [W] x emitted particles: divide by their number.
struct LightParticle {
    Ray ray;
    Spectrum flux = black();
    const Spectrum* medium =
        nullptr;  ///< absorption [1/m] where the light shines (Scene::light_media)
};

/// What became of emitted particles. Each branch of a split path has its own end: the ends (missed
/// to dropped) add up to `aimed` + `branched`.
struct LightPathCounts {
    std::uint64_t emitted = 0;  ///< drawn, including those thinned out at the light
    std::uint64_t aimed = 0;    ///< sent on their way
    /// Second branches begun by splitting, or by leaving light on a mirror and going on.
    std::uint64_t branched = 0;
    std::uint64_t reflected = 0;  ///< specular events that went on by reflection
    std::uint64_t refracted = 0;  ///< and by refraction
    std::uint64_t missed = 0;     ///< met no caster first
    std::uint64_t escaped = 0;    ///< left the scene after a caster
    std::uint64_t absorbed = 0;   ///< by roulette, a medium, or a coloured surface
    /// Sent to the wrong side of the surface by a smooth normal (SpecularSplit::lost_weight).
    std::uint64_t misdirected = 0;
    std::uint64_t on_black_side = 0;  ///< arrived where a receiver is black, mostly behind it
    std::uint64_t depth_limited = 0;  ///< met one more caster after `max_bounces`
    std::uint64_t stored = 0;
    std::uint64_t dropped = 0;  ///< arrived, but left out so that a wanted number is exact
    /// What became of their light [W x emitted]; of caustic paths alone.
    LightLedger light = {};

    /// The same in watts; all zeros where nothing was emitted.
    LightLedger watts() const;
    void add(const LightPathCounts& other);
    void add_to(Counters& counters) const;
};

/// The counts that add_to() has put there.
LightPathCounts light_path_counts(const Counters& counters);

/// What happens at a surface that both reflects and refracts.
enum class Interaction {
    roulette,  ///< one decision by Russian roulette, the survivor's channels rescaled [J96 sec. 2], [C11]
    split  ///< both are followed, each with its weight (POV-Ray's way, as [C11] describes it)
};

/// With `split`, a branch that carries less than this share of its particle's flux continues with a
/// probability of (its share / this), and then with this share: its mean stays, and a path has at
/// most 1 / this branches at a time on average.
inline constexpr float lightest_branch = 1.0F / 64;

struct LightPathSettings {
    int max_bounces = most_bounces;  ///< specular events between light and receiver
    Interaction interaction = Interaction::roulette;
    std::vector<Ray>* traced = nullptr;  ///< gets every ray that is traced; for measuring
    /// Where given, paths that start side by side share the wavelengths out by their numbers, turned by
    /// this part of all; else each draws its own.
    std::optional<double> wavelength_shift = {};
};

/// Follows a particle through specular surfaces to the first that is a receiver alone, with reflection
/// or refraction decided by Russian roulette whose probabilities weigh the channels. At most
/// `max_bounces` specular events. Appends what it leaves there, and before that on each surface that is
/// a receiver and a caster, in the order of the path. Rows J3, J9.
void trace_light_path(const Scene& scene, const LightParticle& particle,
                      const LightPathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits);

/// A particle on its start, with the random numbers of its path.
struct LightPathStart {
    LightParticle particle;
    Rng rng;
    std::uint64_t path = 0;  ///< its number
};

/// A deposit, and the start in a span of them that brought it.
struct DepositOfMany {
    std::size_t start;
    Deposit deposit;
};

/// trace_light_path for many particles side by side, one segment of all of them after the other.
/// Made for particles that leave near each other: their rays share the way through the scene
/// (Scene::intersect_together). `deposits` gets those of all starts, in their order.
void trace_light_paths(const Scene& scene, std::span<LightPathStart> starts,
                       const LightPathSettings& settings, LightPathCounts& counts,
                       std::vector<DepositOfMany>& deposits);

/// Follows a particle and all its branches; appends their deposits, in a fixed order.
void trace_split_path(const Scene& scene, const LightParticle& particle,
                      const LightPathSettings& settings, Rng& rng, LightPathCounts& counts,
                      std::vector<Deposit>& deposits);

}  // namespace caustics

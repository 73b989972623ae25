#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "beamtree/tracing/beam_budget.h"

namespace caustics::beamtree {

/// How a beam's light is computed at a point (row B8, and beyond the paper row B13).
enum class Intensity {
    area,    ///< flux / area of the caustic polygon [CC95 (11)]: right to first order at a point
    refined  ///< by the rays' spreads: right to second order where the light is smooth
};

/// Photons that carry light which beams of several events leave out.
struct Completion {
    /// A share of so many paths, as that light is of all on casters; 0: none.
    std::uint64_t photons = 0;
    /// Light beyond `max_beams` alone, not what `prune` leaves out nor what polygons are too coarse for.
    bool of_budget_alone = false;
};

/// How a scene's beams are traced.
struct TraceSettings {
    Intensity intensity = Intensity::area;
    int max_bounces = 1;
    /// Sets of up to so many events are prepared for the search of their rays, with `refined`. Images of later sets are far
    /// from any quadratic: their preparation takes long, and a few roots are lost.
    int root_events = 2;
    /// Of the light of the first events' beams on average: beams with less, were media clear, are not followed.
    double prune = 1e-3;
    /// Of the same light: parts of polygons with less, were media clear, are not divided to see what they meet,
    double least_divided = 0;
    /// but those that have this share of all light, as if each light sent as much to each caster.
    double divided_share = std::numeric_limits<double>::infinity();
    /// Beams of several events, of all lights and casters: those with the most light.
    std::uint64_t max_beams = BeamBudget::no_limit;
    /// Beams that pass all receivers' bounds by more than this [m] are left out; none: no beams are.
    std::optional<float> receiver_margin = {};
    Completion rest = {};
    double watts_per_photon = 0;  ///< of its photons [W]; trace_all_beams() finds it
    /// Paths that tell how much of the light that photons do not complete would come to receivers: it takes its share of so
    /// many, as it is of all light that a caster has of a light.
    std::uint64_t sampled_photons = 0;
    double watts_per_sample = 0;  ///< of these [W]; 0: there are none
    std::uint64_t seed = 1;
    int threads = 1;
};

/// What parts of a caster's polygons have at least to be divided, as `least_divided`. The caster has so many polygons, and
/// all casters in all lights are so many parts.
inline double least_to_divide(const TraceSettings& settings, std::size_t polygons,
                              std::size_t parts) {
    return std::min(settings.least_divided, settings.divided_share * static_cast<double>(polygons) *
                                                static_cast<double>(parts));
}

}  // namespace caustics::beamtree

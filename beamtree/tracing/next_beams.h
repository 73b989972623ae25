#pragma once

#include <array>
#include <vector>

#include "beamtree/beams/flux_balance.h"
#include "beamtree/tracing/beam_budget.h"
#include "beamtree/tracing/beam_path.h"

namespace caustics::beamtree {

/// A corner of a beam to be.
struct BeamCorner {
    const RayOrigin* origin;
    const RayArrival* arrival;
    std::uint32_t parent_ray;  ///< or Beam::none
};
using BeamCorners = std::array<BeamCorner, 3>;

/// What a beam must have of light to be followed, were media clear.
struct LeastLight {
    double of_polygon;   ///< over its share of its polygon [W]
    BeamBudget& budget;  ///< counts beams
};

/// The beams that go on from a level's set, in sets of their own: one a caster they meet and event there.
class NextBeams {
public:
    /// Beams with less light than `least`, were media clear, are left out and counted by `balance`.
    NextBeams(const Scene& scene, const LitCaster& surface, Level& level, const LeastLight& least,
              FluxBalance& balance);

    /// A beam between corners that meet one piece of a surface and leave it by an event. It has `share` of its
    /// polygon, a beam of the level's set.
    void add(std::uint32_t parent, const BeamCorners& corners, Event event, float share);
    /// Of the level's light over a part of a polygon [W].
    double flux(const Piece& piece) const;
    /// Whether a part of a polygon has too little light for the budget, whatever it meets.
    bool is_too_weak(const Piece& piece) const;
    std::vector<Level> take() { return std::move(levels_); }

private:
    Spectrum flux(std::uint32_t parent, const BeamCorners& corners, Event event) const;
    Level& level_of(std::uint32_t shape, Event event);

    const Scene& scene_;
    const LitCaster& surface_;
    Level& level_;
    const BeamSet& set_;
    LeastLight least_;
    FluxBalance& balance_;
    std::vector<Level> levels_;
};

}  // namespace caustics::beamtree

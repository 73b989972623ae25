#pragma once

#include <array>
#include <vector>

#include "beamtree/beams/flux_balance.h"
#include "beamtree/tracing/beam_budget.h"
#include "beamtree/tracing/beam_path.h"
#include "beamtree/tracing/rest_photons.h"
#include "beamtree/tracing/set_chunk.h"

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
    double mean;         ///< of the first events' beams [W]
    double of_polygon;   ///< over its share of its polygon [W]
    double to_divide;    ///< to be divided to see what it meets [W]
    BeamBudget& budget;  ///< counts beams
};

/// Beams that go on from some of a level's and meet one caster and event next; keys of rays are rays of the level.
struct NextChunk {
    std::uint32_t shape;
    Event event;
    SetChunk beams;
    std::vector<std::uint32_t> parents;  ///< this and what follows as in Level
    std::vector<RayArrival> places;
    std::vector<float> shares;
    double worth = 0;
};

/// The levels after a level, from what parts of its beams have made, in their order: one a caster and event, in the order
/// in which they are met.
std::vector<Level> join_levels(const Scene& scene, const Level& parent,
                               std::vector<std::vector<NextChunk>> parts, int threads);

/// The beams that go on from some of a level's, in chunks of their own: one a caster they meet and event there.
class NextBeams {
public:
    /// Beams with less light than `least`, were media clear, are left out.
    NextBeams(const Scene& scene, const LitCaster& surface, const Level& level,
              const LeastLight& least, const RestPhotons& rest, FluxBalance& balance);

    /// A beam between corners that meet one piece of a surface and leave it by an event. It has `part` of a piece that has
    /// `share` of its polygon, a beam of the level's set: thin parts are judged by how bright they are, or lines of them
    /// would be dark.
    void add(std::uint32_t parent, const BeamCorners& corners, Event event, float share,
             float part = 1);
    /// Of the level's light over a part of a polygon [W].
    double flux(const Piece& piece) const;
    /// Of a part of a polygon, were media clear, whatever it meets [W]; as its corners tell, and a place inside it.
    double most_light(const Piece& piece, const PathPoint* inside = nullptr) const;
    /// Of a part of a polygon, as its light counts it (measure).
    double size(const Piece& piece) const;
    /// Whether a part of a polygon has too little light for the budget, whatever it meets.
    bool is_too_weak(const Piece& piece) const;
    /// Whether it has enough to be divided to see what it meets.
    bool may_divide(const Piece& piece) const { return most_light(piece) >= least_.to_divide; }
    /// How exactly the edges of a part of a polygon are cut (cut_edge.h): the better the more light it has.
    int halvings(const Piece& piece) const;
    /// A part of a polygon is divided to see what it meets, which costs as much as a beam and counts as one.
    void count_search(const Piece& piece);
    /// Completes light that no beam carries on, and counts it, `flux` [W], by its cause.
    void leave_out(const LeftOut& part, double flux);
    /// True if photons take all that beams leave out.
    bool is_completed() const { return rest_.completes_all(); }
    /// Has photons take what no beam carries on.
    void complete(const LeftOut& part);
    std::vector<RestPhoton> take_rest() { return std::move(photons_); }
    std::vector<NextChunk> take() { return std::move(chunks_); }

private:
    /// Of a beam [W]; one below `dim` is not looked at closely.
    Spectrum flux(std::uint32_t parent, const BeamCorners& corners, Event event, double dim) const;
    /// Of a beam, over its light before all events, from places inside it: so many parts of a side.
    Spectrum weight_inside(std::uint32_t parent, const BeamCorners& corners, Event event,
                           int parts) const;
    int parts_of_side(double light) const;
    NextChunk& chunk_of(std::uint32_t shape, Event event);

    const Scene& scene_;
    const LitCaster& surface_;
    const Level& level_;
    const BeamSet& set_;
    LeastLight least_;
    const RestPhotons& rest_;
    FluxBalance& balance_;
    std::vector<NextChunk> chunks_;
    std::vector<RestPhoton> photons_;
};

}  // namespace caustics::beamtree

#pragma once

#include <array>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/flux_balance.h"
#include "beamtree/beams/lit_caster.h"
#include "beamtree/beams/mesh_neighbours.h"
#include "beamtree/beams/ray_origin.h"
#include "beamtree/beams/trace_progress.h"
#include "beamtree/rest/rest_photon.h"
#include "beamtree/tracing/beam_drift.h"
#include "beamtree/tracing/ray_arrival.h"
#include "beamtree/tracing/scene_boxes.h"
#include "beamtree/tracing/trace_settings.h"

namespace caustics::beamtree {

/// Beams, and the light that they do not carry.
struct TracedBeams {
    std::vector<BeamSet> sets;
    std::vector<RestPhoton> rest;  ///< photons of light that was left out, if they are asked for
    FluxBalance balance;
    DriftAccount drift;
    double least_light = 0;  ///< of a beam that the budget has room for [W]; 0: it has for all
    std::uint64_t unreceived = 0;  ///< beams left out because they meet no receiver
};

/// Of all beams of a set [W, mean of channels].
double flux_of(const BeamSet& set);

/// What sets get beside their rays; each may be null.
struct BeamExtras {
    const MeshNeighbours* neighbours = nullptr;  ///< for spreads
    const BeamDrift* drift = nullptr;            ///< for drifts
};

/// Follows beams of one caster and light from their first event to others (row B13). Each ray goes
/// on to the next surface; where that is a caster, and all corners of a beam meet the same piece of it
/// (a shape's side without a crease), what the piece reflects and refracts makes up beams of two further
/// sets. Their flux is what the light sends onto the first surface, times all weights on the way.
///
/// Where corners do different things (another caster, a crease, total reflection, the light hidden
/// from the first surface, no caster at all), the triangle of the first surface is cut by bisection
/// along its edges, and three different things quarter it. What lies between corners that do one
/// thing is taken to do the same: an obstacle smaller than a polygon does not interrupt a beam on its
/// way. The last leg, from the last event to a receiver, is left to the shadow ray of a query; all
/// beams stay for that, but those which no receiver can come near before their light leaves, or ever.
///
/// Sets with less than a tenth of `prune` of the first events' flux, and beams with less than `prune` of those of
/// the first events on average, are not kept, nor beams below the budget's least; `balance` counts them. What media absorb counts for neither:
/// light that comes through dark glass is weak, and all there is.
class BeamBounces {
public:
    BeamBounces(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
                const BeamExtras& extras, const TraceSettings& settings, BeamBudget& budget);

    /// Keeps the sets of the first events and those of all events after them; none once beams are more than the
    /// budget, which then only counts them, to say what those that fit have at least.
    void follow(std::array<TracedSet, 2> first, const ProgressPart& part);
    /// Sets in the order of their light: each before those that its light reaches.
    TracedBeams take() { return std::move(traced_); }

private:
    std::vector<Departure> first_departures(const TracedSet& first) const;

    const Scene& scene_;
    const SceneBoxes& boxes_;
    const LitCaster& surface_;
    BeamExtras extras_;
    TraceSettings settings_;
    BeamBudget& budget_;
    TracedBeams traced_;
};

}  // namespace caustics::beamtree

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "beamtree/rest/rest_photon.h"
#include "beamtree/tracing/beam_path.h"
#include "beamtree/tracing/trace_settings.h"

namespace caustics::beamtree {

/// Light that no beam carries on: of a triangle on the first surface, on the way of a beam and through its next event.
struct LeftOut {
    std::uint32_t beam;  ///< of the level whose light it is
    std::array<const RayOrigin*, 3> corners;
    std::optional<Event> event;  ///< the next; none: both
    double flux;                 ///< at most, about, after it [W]: so many photons are traced
    bool over_budget = false;    ///< because `max_beams` has no room for it
};

/// Traces light that beams leave out by photons, from one caster in one light: all of it, or a sample where it is not to be
/// completed. Each begins at a random place of the
/// triangle, goes the beam's way, through the event, and from there on to receivers by Russian roulette. What
/// arrives before the event belongs to the beam. So nothing counts twice, and the mean over seeds is what was left out,
/// but where light of the triangle does not go the beam's way, as beams lose it too.
///
/// How many photons a triangle sends is in proportion to its flux, rounded up or down so that whole polygons beside
/// each other in the mesh share them evenly. Random numbers are named by the triangle and its light's way: neither threads
/// nor what else is traced changes them.
class RestPhotons {
public:
    /// `settings` give the light of a photon and of one of a sample; without, there are none.
    RestPhotons(const Scene& scene, const LitCaster& surface, const TraceSettings& settings);

    /// True if all that is left out is light of the picture, and not only what `max_beams` has no room for.
    bool completes_all() const {
        return settings_.rest.photons > 0 && !settings_.rest.of_budget_alone;
    }
    /// Appends what arrives; `level` is that of the beam.
    void trace(const Level& level, const LeftOut& part, std::vector<RestPhoton>& photons) const;

private:
    bool completes(const LeftOut& part) const {
        return completes_all() || (settings_.rest.photons > 0 && part.over_budget);
    }

    const Scene& scene_;
    const LitCaster& surface_;
    TraceSettings settings_;
};

}  // namespace caustics::beamtree

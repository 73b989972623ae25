#pragma once

#include <string>

namespace caustics::beamtree {

/// What becomes of the light that casters bend [W, mean of channels].
struct FluxBalance {
    double lit = 0;          ///< leaves first surfaces that the light sees
    double lost = 0;         ///< reaches a further caster, and no beam carries it
    double pruned = 0;       ///< and of that in paths too weak to be followed
    double over_budget = 0;  ///< and in beams with less light than the budget's least
    double missed = 0;       ///< and of all that what receivers miss, as a sample tells

    /// Adds another one, so many times.
    void add(const FluxBalance& other, double times = 1) {
        lit += times * other.lit;
        lost += times * other.lost;
        pruned += times * other.pruned;
        over_budget += times * other.over_budget;
        missed += times * other.missed;
    }
    /// The share that beams carry to the last event on its way (or that of `max_bounces`).
    double captured() const { return lit > 0 ? 1 - lost / lit : 1; }
};

/// Throws UnsupportedScene where beams lose most of the light, in the name of `method`; `where` ("" or " in a
/// sample of ...") says of which beams.
void require_most_light(const FluxBalance& balance, const std::string& method,
                        const std::string& where);

}  // namespace caustics::beamtree

#pragma once

namespace caustics::beamtree {

/// What becomes of the light that casters bend [W, mean of channels].
struct FluxBalance {
    double lit = 0;     ///< leaves first surfaces that the light sees
    double lost = 0;    ///< reaches a further caster, and no beam carries it
    double pruned = 0;  ///< and of that in paths too weak to be followed

    void add(const FluxBalance& other) {
        lit += other.lit;
        lost += other.lost;
        pruned += other.pruned;
    }
    /// The share that beams carry to the last event on its way (or that of `max_bounces`).
    double captured() const { return lit > 0 ? 1 - lost / lit : 1; }
};

}  // namespace caustics::beamtree

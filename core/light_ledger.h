#pragma once

namespace caustics {

/// What becomes of the light that reaches casters [W, mean of channels]: all that is sent there either arrives on
/// receivers or is lost in one of the other ways. Methods that count light before they know the number of their
/// light paths divide it later (scaled()).
struct LightLedger {
    double sent = 0;     ///< to casters by lights, and by receivers that are mirrors, too
    double arrived = 0;  ///< on receivers, after casters
    double cut = 0;      ///< meets one more caster after `max_bounces` events
    double pruned = 0;   ///< not followed: too weak, too many beams, or polygons too coarse for it
    /// Sent to the wrong side of a surface by a smooth normal (SpecularSplit::lost_weight).
    double misdirected = 0;
    double absorbed = 0;  ///< by media, by coloured surfaces, and by the black sides of receivers
    double escaped = 0;   ///< leaves the scene after a caster

    /// The sum of all ways to end, which is what was sent.
    double ended() const { return arrived + cut + pruned + misdirected + absorbed + escaped; }

    LightLedger scaled(double factor) const {
        LightLedger result;
        result.add(*this, factor);
        return result;
    }
    /// Adds another one, so many times.
    void add(const LightLedger& other, double times = 1) {
        visit(*this, other, [times](double& own, double others) { own += times * others; });
    }

    /// Calls act(value of one, value of the other) for each of the values.
    template <typename One, typename Other, typename Act>
    static void visit(One& one, Other& other, const Act& act) {
        act(one.sent, other.sent);
        act(one.arrived, other.arrived);
        act(one.cut, other.cut);
        act(one.pruned, other.pruned);
        act(one.misdirected, other.misdirected);
        act(one.absorbed, other.absorbed);
        act(one.escaped, other.escaped);
    }
};

}  // namespace caustics

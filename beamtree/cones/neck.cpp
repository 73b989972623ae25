#include "beamtree/cones/neck.h"

#include <cmath>
#include <limits>

namespace caustics::beamtree {
namespace {

struct Plane {
    double depth;
    double size;
};

/// Three depths with the least size in the middle.
struct Bracket {
    Plane left, middle, right;

    // [CC95 (2)]
    double proposed() const {
        return (left.size * right.depth + right.size * left.depth) / (left.size + right.size);
    }
    // Into the longer half.
    double golden() const {
        constexpr double share = 0.381966011250105;
        return right.depth - middle.depth > middle.depth - left.depth
                   ? middle.depth + share * (right.depth - middle.depth)
                   : middle.depth - share * (middle.depth - left.depth);
    }
    void take(const Plane& now) {
        const bool better = now.size < middle.size;
        if (now.depth < middle.depth)
            better ? (right = middle, middle = now) : (left = now);
        else
            better ? (left = middle, middle = now) : (right = now);
    }
};

}  // namespace

double find_neck(const std::function<double(double)>& size, double first, double last) {
    const auto at = [&](double depth) { return Plane{depth, size(depth)}; };
    Bracket bracket{at(first), at((first + last) / 2), at(last)};
    // No bracket yet: halve towards the smaller end. A convex size that falls to an end stays there.
    for (int i = 0; i < 40 && !(bracket.middle.size <= bracket.left.size &&
                                bracket.middle.size <= bracket.right.size);
         ++i) {
        if (bracket.left.size < bracket.right.size)
            bracket.right = bracket.middle;
        else
            bracket.left = bracket.middle;
        bracket.middle = at((bracket.left.depth + bracket.right.depth) / 2);
    }
    const double close = 1e-4 * (last - first);
    for (int i = 0; i < 24 && bracket.right.depth - bracket.left.depth > close; ++i) {
        const double proposed = bracket.proposed();
        const bool inside = proposed > bracket.left.depth && proposed < bracket.right.depth;
        const bool stalls = std::abs(proposed - bracket.middle.depth) < close / 10;
        bracket.take(at(inside && !stalls && i % 2 == 0 ? proposed : bracket.golden()));
    }
    Plane best = bracket.middle;
    for (const Plane& end : {bracket.left, bracket.right})
        if (end.size < best.size) best = end;
    return best.depth;
}

}  // namespace caustics::beamtree

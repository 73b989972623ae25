#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/math/vec.h"

namespace caustics {

/// n x n texels over the unit square of a surface's texture coordinates, written and read
/// bilinearly [Arvo 1986]: a place shares among the four texels whose centres surround it. At an edge
/// the outermost texel stands for what is missing, or, where the coordinate goes round, the texel of
/// the other edge.
class TexelGrid {
public:
    /// A texel's share of a place; the four shares add up to 1.
    struct Tap {
        std::size_t texel;
        double share;
    };

    /// `round_u`, `round_v`: whether that coordinate's ends 0 and 1 are the same place.
    TexelGrid(int resolution, bool round_u, bool round_v)
        : n_(resolution), round_{round_u, round_v} {}

    int resolution() const { return n_; }
    std::size_t size() const { return static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_); }

    std::array<Tap, 4> taps(const Vec2d& uv) const {
        const Pair u = pair(uv.x(), round_[0]);
        const Pair v = pair(uv.y(), round_[1]);
        return {{{index(u.low, v.low), (1 - u.share) * (1 - v.share)},
                 {index(u.high, v.low), u.share * (1 - v.share)},
                 {index(u.low, v.high), (1 - u.share) * v.share},
                 {index(u.high, v.high), u.share * v.share}}};
    }

private:
    /// The texels whose centres surround a coordinate, and the share of the second.
    struct Pair {
        int low, high;
        double share;
    };

    Pair pair(double x, bool round) const {
        const double place = std::clamp(x, 0.0, 1.0) * n_ - 0.5;
        const double below = std::floor(place);
        const int low = static_cast<int>(below);
        if (round) return {(low + n_) % n_, (low + 1) % n_, place - below};
        return {std::max(low, 0), std::min(low + 1, n_ - 1), place - below};
    }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(n_) +
               static_cast<std::size_t>(column);
    }

    int n_;
    std::array<bool, 2> round_;
};

}  // namespace caustics

#pragma once

#include <array>
#include <cstddef>

namespace caustics::beamtree {

/// The part of a triangle where light does one thing: none, three or four corners.
template <typename Point>
struct CutPiece {
    std::array<Point, 4> corners;
    std::size_t count = 0;
};

/// The quarters of a triangle, by the middles of its edges. `between` as below.
template <typename Point, typename Between>
std::array<std::array<Point, 3>, 4> quarters(const std::array<Point, 3>& piece,
                                             const Between& between) {
    const auto& [a, b, c] = piece;
    const Point ab = between(a, b, 0.5F);
    const Point bc = between(b, c, 0.5F);
    const Point ca = between(c, a, 0.5F);
    return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
}

/// The last point from `good` towards `bad` at which `holds` is true, and one just behind it, found by
/// bisection. `between` makes the point (1 - t) a + t b.
template <typename Point, typename Holds, typename Between>
std::array<Point, 2> last_and_next(const Point& good, const Point& bad, int steps,
                                   const Holds& holds, const Between& between) {
    std::array<Point, 2> found = {between(good, bad, 0.0F), bad};
    float low = 0;
    float high = 1;
    for (int step = 0; step < steps; ++step) {
        const float t = (low + high) / 2;
        const Point here = between(good, bad, t);
        const bool good_here = holds(here);
        (good_here ? low : high) = t;
        found[good_here ? 0 : 1] = here;
    }
    return found;
}

/// The corners of a triangle at which `holds` is true, and on each edge between such a one and
/// another the last point where it is. Neighbours that share an edge find the same bits, because both go
/// from its good end.
template <typename Point, typename Holds, typename Between>
CutPiece<Point> cut_piece(const std::array<Point, 3>& piece, int steps, const Holds& holds,
                          const Between& between) {
    const auto last = [&](const Point& from, const Point& to) {
        return last_and_next(from, to, steps, holds, between)[0];
    };
    CutPiece<Point> cut;
    std::array<bool, 3> good;
    for (std::size_t i = 0; i < 3; ++i) good[i] = holds(piece[i]);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (good[i]) cut.corners[cut.count++] = piece[i];
        if (good[i] != good[next])
            cut.corners[cut.count++] =
                good[i] ? last(piece[i], piece[next]) : last(piece[next], piece[i]);
    }
    return cut;
}

}  // namespace caustics::beamtree

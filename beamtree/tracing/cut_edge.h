#pragma once

#include "beamtree/tracing/beam_path.h"

namespace caustics::beamtree {

/// Whether the light of a point has come to a caster after its path.
bool goes_on(const PathPoint& point);
/// Whether the light of both does the same next: ends, or continues by the same events from the same piece of a
/// caster.
bool alike(const PathPoint& a, const PathPoint& b);

/// An edge of a piece, from corner to corner, where they do different things.
struct CutEdge {
    bool is_cut = false;
    bool hides_another = false;  ///< a third thing between
    PathPoint last;              ///< that does as the first corner
    PathPoint first;             ///< that does as the second one
};

/// Most halvings of an edge that cut_edge() is asked for: where it is cut is then known to a 16,000th.
constexpr int most_halvings = 14;
/// Finds by so many bisections where along an edge light does another thing. Neighbours that bisect it as often find
/// the same points, because both begin at the same end. With `ends_at_third` a third thing between ends the search, and
/// the edge has no points.
CutEdge cut_edge(const Path& path, const PathPoint& a, const PathPoint& b, int halvings,
                 bool ends_at_third);

}  // namespace caustics::beamtree

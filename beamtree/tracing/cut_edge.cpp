#include "beamtree/tracing/cut_edge.h"

#include <algorithm>

#include "beamtree/tracing/cut_piece.h"

namespace caustics::beamtree {
bool goes_on(const PathPoint& p) { return p.alive && p.next.goes_on(); }
bool alike(const PathPoint& a, const PathPoint& b) {
    if (!goes_on(a) || !goes_on(b)) return goes_on(a) == goes_on(b);
    for (const Event event : events)
        if (is_black(a.next.weight[event]) != is_black(b.next.weight[event])) return false;
    return same_piece(a.next, b.next);
}

CutEdge cut_edge(const Path& path, const PathPoint& a, const PathPoint& b, int halvings) {
    CutEdge edge;
    if (alike(a, b)) return edge;
    const auto search = [&](const PathPoint& from, const PathPoint& to) {
        return last_and_next(
            from, to, halvings, [&](const PathPoint& p) { return alike(p, from); },
            [&](const PathPoint& p, const PathPoint& q, float t) { return path.between(p, q, t); });
    };
    const Vec3& p = a.origin.position;
    const Vec3& q = b.origin.position;
    const bool forward = std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    const PathPoint& low = forward ? a : b;
    const PathPoint& high = forward ? b : a;
    auto [last, next] = search(low, high);
    edge.is_cut = true;
    edge.hides_another = !alike(next, high);
    if (edge.hides_another) next = search(high, low)[0];
    next.origin.vertex = RayOrigin::no_vertex;
    edge.last = forward ? last : next;
    edge.first = forward ? next : last;
    return edge;
}

}  // namespace caustics::beamtree

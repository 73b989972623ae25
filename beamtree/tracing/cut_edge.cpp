#include "beamtree/tracing/cut_edge.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace caustics::beamtree {
namespace {

// Of the rays between two, those so close to where planes meet are looked at.
constexpr float about_crossing = 1.0F / 256;

bool meets_facet(const PathPoint& p) { return goes_on(p) && p.next.flat; }

// Where between two rays, were those between linear, they meet two facets' planes at once: there the ways to both are
// alike, N_A / D_A = N_B / D_B. None where that is not between them.
std::optional<float> crossing(const PathPoint& a, const PathPoint& b) {
    if (!meets_facet(a) || !meets_facet(b) || same_piece(a.next, b.next)) return {};
    const auto at = [&](double t) {
        const Vec3d from =
            (1 - t) * a.ray.position.cast<double>() + t * b.ray.position.cast<double>();
        const Vec3d along =
            (1 - t) * a.ray.direction.cast<double>() + t * b.ray.direction.cast<double>();
        const auto height = [&from](const RayArrival& on) {
            return on.geometric_normal.cast<double>().dot(on.position.cast<double>() - from);
        };
        const auto slope = [&along](const RayArrival& on) {
            return on.geometric_normal.cast<double>().dot(along);
        };
        return height(a.next) * slope(b.next) - height(b.next) * slope(a.next);
    };
    const double first = at(0);
    const double last = at(1);
    if (!(first * last < 0)) return {};
    const double square = 2 * (first - 2 * at(0.5) + last);
    const double linear = last - first - square;
    const double root = std::sqrt(std::max(0.0, linear * linear - 4 * square * first));
    const double sum = -(linear + std::copysign(root, linear)) / 2;
    const double t = sum / square;
    return static_cast<float>(t > 0 && t < 1 ? t : first / sum);
}

/// Searches between two points that do different things for the last that does as the first one, and the next that does
/// not. Between facets most of the halvings are left out.
class Search {
public:
    Search(const Path& path, const PathPoint& from, const PathPoint& to)
        : path_(path), from_(from), to_(to), last_(path.between(from, to, 0)), next_(to) {}

    void run(int halvings, bool ends_at_third) {
        const float wanted = std::ldexp(1.0F, -halvings);
        while (high_ - low_ > wanted && !(ends_at_third && finds_third_)) {
            const float width = high_ - low_;
            if (const std::optional<float> share = crossing(last_, next_)) {
                const float t = low_ + *share * width;
                const float about = std::max(0.45F * wanted, about_crossing * width);
                look_at(t - about);
                look_at(t + about);
            }
            if (high_ - low_ > width / 2) look_at((low_ + high_) / 2);
        }
    }

    const PathPoint& last() const { return last_; }
    const PathPoint& next() const { return next_; }
    bool finds_third() const { return finds_third_; }

private:
    void look_at(float t) {
        if (!(low_ < t && t < high_)) return;
        const PathPoint here = path_.between(from_, to_, t);
        const bool is_as_first = alike(here, from_);
        (is_as_first ? low_ : high_) = t;
        (is_as_first ? last_ : next_) = here;
        finds_third_ = finds_third_ || (!is_as_first && !alike(here, to_));
    }

    const Path& path_;
    const PathPoint& from_;
    const PathPoint& to_;
    float low_ = 0;
    float high_ = 1;
    PathPoint last_;
    PathPoint next_;
    bool finds_third_ = false;
};

}  // namespace

bool goes_on(const PathPoint& p) { return p.alive && p.next.goes_on(); }
bool alike(const PathPoint& a, const PathPoint& b) {
    if (!goes_on(a) || !goes_on(b)) return goes_on(a) == goes_on(b);
    for (const Event event : events)
        if (is_black(a.next.weight[event]) != is_black(b.next.weight[event])) return false;
    return same_piece(a.next, b.next);
}

CutEdge cut_edge(const Path& path, const PathPoint& a, const PathPoint& b, int halvings,
                 bool ends_at_third) {
    CutEdge edge;
    if (alike(a, b)) return edge;
    const Vec3& p = a.origin.position;
    const Vec3& q = b.origin.position;
    const bool forward = std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    const PathPoint& low = forward ? a : b;
    const PathPoint& high = forward ? b : a;
    Search search(path, low, high);
    search.run(halvings, ends_at_third);
    edge.is_cut = true;
    edge.hides_another = search.finds_third();
    if (edge.hides_another && ends_at_third) return edge;
    PathPoint next = search.next();
    if (!alike(next, high)) {
        Search back(path, high, low);
        back.run(halvings, false);
        next = back.last();
    }
    next.origin.vertex = RayOrigin::no_vertex;
    edge.last = forward ? search.last() : next;
    edge.first = forward ? next : search.last();
    return edge;
}

}  // namespace caustics::beamtree

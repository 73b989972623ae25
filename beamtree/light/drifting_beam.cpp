#include "beamtree/light/drifting_beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "beamtree/light/projected.h"

namespace caustics::beamtree {
namespace {

// Of a bin where edges do not tell.
constexpr int narrow_parts = 16;
// Within an interval the area should change by no more than this share, or there are this many parts.
constexpr double steady = 0.2;
constexpr int most_parts = 8;

/// A corner on the plane, at the places -1 to 1 of the bin.
struct MovingCorner {
    Vec2d middle;
    Vec2d half;

    Vec2d at(double place) const { return middle + place * half; }
};

using MovingTriangle = std::array<MovingCorner, 3>;

// Empty where the plane cuts the triangle or its light is uneven.
std::optional<MovingTriangle> moving_triangle(const BeamSet& set, const Beam& beam,
                                              std::size_t which, const TestPlane& plane) {
    const std::array<std::uint32_t, 3> corners = beam.triangle_corners(which);
    MovingTriangle triangle;
    double least = 1;
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const RayOnPlane a = on_plane(set.ends[0][corners[i]], plane);
        const RayOnPlane b = on_plane(set.ends[1][corners[i]], plane);
        if (!a.comes_down() || !b.comes_down()) return {};
        triangle[i] = {(a.at + b.at) / 2, (b.at - a.at) / 2};
        least = std::min({least, a.steepness, b.steepness});
        most = std::max({most, a.steepness, b.steepness});
    }
    if (most > most_uneven * least) return {};
    return triangle;
}

// Most beams that a tree has found do: on one axis all corners stay on one side of the point.
bool passes_by(const MovingTriangle& triangle) {
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d high = -low;
    for (const MovingCorner& corner : triangle) {
        const Eigen::Array2d far = corner.half.array().abs();
        low = low.min(corner.middle.array() - far);
        high = high.max(corner.middle.array() + far);
    }
    return (low > 0).any() || (high < 0).any();
}

/// Places in (-1, 1) where a point changes sides, in order; -1 first and 1 last.
class Places {
public:
    // Where the edge from a to b runs through the origin: roots of a x b.
    void add_crossings(const MovingCorner& a, const MovingCorner& b) {
        const double constant = cross(a.middle, b.middle);
        const double linear = cross(a.middle, b.half) + cross(a.half, b.middle);
        const double square = cross(a.half, b.half);
        const double discriminant = linear * linear - 4 * square * constant;
        if (!(discriminant >= 0)) return;
        // Without cancellation.
        const double q = -(linear + std::copysign(std::sqrt(discriminant), linear)) / 2;
        if (square != 0) add(q / square);
        if (q != 0) add(constant / q);
    }
    std::size_t count() const { return count_; }
    double operator[](std::size_t i) const { return places_[i]; }

private:
    void add(double place) {
        if (!(place > -1 && place < 1) || count_ == places_.size()) return;
        std::size_t i = count_++;
        for (; i > 0 && places_[i - 1] > place; --i) places_[i] = places_[i - 1];
        places_[i] = place;
    }

    std::array<double, 8> places_ = {-1, 1};  // and two for each edge
    std::size_t count_ = 2;
};

Projected projected_at(const MovingTriangle& triangle, double place) {
    return projected(triangle[0].at(place), triangle[1].at(place), triangle[2].at(place));
}

// Over an interval with this area in its middle, by Simpson's rule where the polygon does not turn over.
double mean_inverse_area(const MovingTriangle& triangle, double from, double to, double middle) {
    const double first = projected_at(triangle, from).area;
    const double last = projected_at(triangle, to).area;
    if (first * middle <= 0 || last * middle <= 0) return 1 / std::abs(middle);
    return std::abs(1 / first + 4 / middle + 1 / last) / 6;
}

void add_hits(const MovingTriangle& triangle, double from, double to, const BeamHit& like,
              const TestPlane& plane, std::vector<BeamHit>& hits) {
    const Projected middle = projected_at(triangle, (from + to) / 2);
    if (!middle.is_hit()) return;
    const double change =
        std::abs(projected_at(triangle, to).area - projected_at(triangle, from).area) /
        std::abs(middle.area);
    const int parts =
        static_cast<int>(std::clamp(std::ceil(change / steady), 1.0, 1.0 * most_parts));
    for (int i = 0; i < parts; ++i) {
        BeamHit hit = like;
        hit.from = from + (to - from) * i / parts;
        hit.to = from + (to - from) * (i + 1) / parts;
        const Projected still = parts == 1 ? middle : projected_at(triangle, hit.place());
        if (!still.is_hit()) continue;
        hit.winding = still.area > 0 ? 1 : -1;
        hit.area = plane.area_scale() / mean_inverse_area(triangle, hit.from, hit.to, still.area);
        hit.weights = still.weights.cast<float>();
        hits.push_back(hit);
    }
}

void add_narrow_hits(const BeamSet& set, const BeamHit& like, const TestPlane& plane,
                     std::vector<BeamHit>& hits) {
    for (int i = 0; i < narrow_parts; ++i) {
        const double from = -1 + 2.0 * i / narrow_parts;
        const double to = -1 + 2.0 * (i + 1) / narrow_parts;
        auto hit = test_triangle(set.triangle(set.beams[like.beam], like.triangle, (from + to) / 2),
                                 like.triangle, plane);
        if (!hit) continue;
        hit->set = like.set;
        hit->beam = like.beam;
        hit->flux_share *= like.flux_share;
        hit->from = from;
        hit->to = to;
        hits.push_back(*hit);
    }
}

}  // namespace

void find_in_drifting_beam(const BeamSet& set, const BeamNumber& number, const TestPlane& plane,
                           std::vector<BeamHit>& hits) {
    const Beam& beam = set.beams[number.beam];
    for (std::size_t which = 0; which < beam.triangle_count(); ++which) {
        BeamHit like;
        like.set = number.set;
        like.beam = number.beam;
        like.triangle = static_cast<std::uint8_t>(which);
        like.plane_normal = plane.normal().cast<float>();
        like.flux_share = beam.share_of(which);
        const auto triangle = moving_triangle(set, beam, which, plane);
        if (!triangle) {
            add_narrow_hits(set, like, plane, hits);
            continue;
        }
        if (passes_by(*triangle)) continue;
        Places places;
        for (std::size_t i = 0; i < 3; ++i)
            places.add_crossings((*triangle)[i], (*triangle)[(i + 1) % 3]);
        for (std::size_t i = 0; i + 1 < places.count(); ++i)
            add_hits(*triangle, places[i], places[i + 1], like, plane, hits);
    }
}

}  // namespace caustics::beamtree

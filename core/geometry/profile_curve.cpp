#include "core/geometry/profile_curve.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/base/error.h"

namespace caustics {
namespace {

constexpr std::size_t most_pieces = 4096;

std::string place_text(const Vec2d& p) { return fmt::format("[{:g}, {:g}]", p.x(), p.y()); }

// The points with their neighbours. Those of a pole lie across the axis, unless it is a cone's tip, which is a crease
// in any case; those of a ring's ends lie across its seam.
class Curve {
public:
    explicit Curve(const LatheProfile& profile)
        : profile_(profile),
          ring_(at(0) == at(spans()) && at(0).x() > 0),
          first_is_tip_(meets_axis_aslant(0, 1, 2)),
          last_is_tip_(meets_axis_aslant(spans(), spans() - 1, spans() - 2)) {}

    std::size_t spans() const { return profile_.points.size() - 1; }
    bool is_ring() const { return ring_; }
    const Vec2d& at(std::size_t i) const { return profile_.points[i].at; }

    Vec2d place(std::size_t span, double s) const;
    Vec2d way(std::size_t span, double s) const;

private:
    std::optional<Vec2d> before(std::size_t i) const {
        if (i > 0) return at(i - 1);
        if (ring_) return at(spans() - 1);
        if (at(0).x() > 0 || first_is_tip_) return {};
        return Vec2d(-at(1).x(), at(1).y());
    }
    std::optional<Vec2d> after(std::size_t i) const {
        if (i < spans()) return at(i + 1);
        if (ring_) return at(1);
        if (at(i).x() > 0 || last_is_tip_) return {};
        const Vec2d& last = at(spans() - 1);
        return Vec2d(-last.x(), last.y());
    }
    double knots(const Vec2d& a, const Vec2d& b) const {
        const double length = (b - a).norm();
        return profile_.catmull_rom ? std::sqrt(length) : length;
    }
    bool is_crease(std::size_t i) const {
        return profile_.points[i].crease ||
               (ring_ && (i == 0 || i == spans()) &&
                (profile_.points.front().crease || profile_.points.back().crease));
    }
    bool meets_axis_aslant(std::size_t pole, std::size_t next, std::size_t second) const;
    std::optional<Vec2d> smooth_slope(std::size_t i) const;
    std::pair<Vec2d, Vec2d> slopes(std::size_t span) const;

    const LatheProfile& profile_;
    bool ring_;
    bool first_is_tip_, last_is_tip_;  ///< of a cone
};

// True where straight lines end on the axis at the tip of a cone. Points of a smooth cap (a sphere, a lens) have first
// lines that are aslant as well: the tangent at the pole is that of the circle through the pole and the next two
// points, and a cap's is nearer to the normal of the axis than to the first line. A crease, or a turn by more than a
// right angle, ends what the first line is part of. A Catmull-Rom curve is mirrored by the axis before it is drawn:
// its tangent there is never aslant, unless the pole is a crease.
bool Curve::meets_axis_aslant(std::size_t pole, std::size_t next, std::size_t second) const {
    if (profile_.catmull_rom || at(pole).x() > 0) return false;
    const Vec2d line = at(next) - at(pole);
    const double slope = std::atan2(std::abs(line.y()), line.x());
    double tangent = slope;
    if (second < profile_.points.size() && !profile_.points[next].crease) {
        const Vec2d onwards = at(second) - at(next);
        if (line.dot(onwards) > 0) {
            const double turn =
                std::copysign(1.0, line.y()) * std::atan2(cross(line, onwards), line.dot(onwards));
            tangent -= turn * line.norm() / (line.norm() + onwards.norm());
        }
    }
    return tangent > slope / 2;
}

// Derivative with respect to the knots at a point that is no crease, by the parabola through it and
// its neighbours. For straight lines, whose knots are lengths, it has the tangent of their circle.
std::optional<Vec2d> Curve::smooth_slope(std::size_t i) const {
    const auto previous = before(i);
    const auto next = after(i);
    if (is_crease(i) || !previous || !next) return {};
    const double h0 = knots(*previous, at(i));
    const double h1 = knots(at(i), *next);
    const Vec2d in = (at(i) - *previous) / h0;
    const Vec2d out = (*next - at(i)) / h1;
    const Vec2d slope = (h1 * in + h0 * out) / (h0 + h1);
    // After a sharp bend the circle may run backwards along a line.
    const bool backwards = slope.dot(in) <= 0 || slope.dot(out) <= 0;
    return !profile_.catmull_rom && backwards ? (in + out).eval() : slope;
}

// At both ends of a span. An end without a smooth slope continues the parabola of the other one.
std::pair<Vec2d, Vec2d> Curve::slopes(std::size_t span) const {
    const Vec2d chord = (at(span + 1) - at(span)) / knots(at(span), at(span + 1));
    const auto first = smooth_slope(span);
    const auto last = smooth_slope(span + 1);
    return {first ? *first : (last ? (2 * chord - *last).eval() : chord),
            last ? *last : (first ? (2 * chord - *first).eval() : chord)};
}

Vec2d Curve::place(std::size_t span, double s) const {
    const Vec2d &a = at(span), &b = at(span + 1);
    if (s == 0) return a;
    if (s == 1) return b;
    if (!profile_.catmull_rom) return (1 - s) * a + s * b;
    const auto [m0, m1] = slopes(span);
    const double h = knots(a, b);
    const double t = 1 - s;
    // Hermite's cubic.
    return (1 + 2 * s) * t * t * a + s * s * (3 - 2 * s) * b +
           h * (s * t * t * m0 - s * s * t * m1);
}

// The direction of travel, unit.
Vec2d Curve::way(std::size_t span, double s) const {
    const auto [m0, m1] = slopes(span);
    const Vec2d chord = at(span + 1) - at(span);
    Vec2d slope = (1 - s) * m0 + s * m1;
    if (profile_.catmull_rom) {
        const double t = 1 - s;
        slope = 6 * s * t * chord / knots(at(span), at(span + 1)) + t * (1 - 3 * s) * m0 +
                s * (3 * s - 2) * m1;
    }
    return slope.norm() > 1e-9 * chord.norm() ? slope.normalized() : chord.normalized();
}

Vec2d normal_of(const Vec2d& way) { return {way.y(), -way.x()}; }

void check_points(const LatheProfile& profile) {
    const auto& points = profile.points;
    if (points.size() < 2) throw InputError("a profile takes at least 2 points");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec2d& p = points[i].at;
        if (p.x() < 0)
            throw InputError(
                fmt::format("point {} {} lies across the axis (r < 0)", i, place_text(p)));
        if (i + 1 < points.size() && (points[i + 1].at - p).norm() == 0)
            throw InputError(
                fmt::format("points {} and {} coincide at {}", i, i + 1, place_text(p)));
        if (p.x() == 0 && i > 0 && i + 1 < points.size())
            throw InputError(
                fmt::format("point {} {} is on the axis between the ends", i, place_text(p)));
    }
    if (points.size() == 2 && points[0].at.x() == 0 && points[1].at.x() == 0)
        throw InputError("the profile runs along the axis");
    if (points.front().at == points.back().at && points.front().at.x() == 0)
        throw InputError("the profile begins and ends at one point of the axis");
}

void check_ends(const Curve& curve, bool open) {
    if (open || curve.is_ring()) return;
    for (const std::size_t end : {std::size_t{0}, curve.spans()})
        if (curve.at(end).x() > 0)
            throw InputError(fmt::format(
                "the profile's {} end {} is off the axis (r = 0), so the surface has a hole; give "
                "\"open\": true if it should",
                end == 0 ? "first" : "last", place_text(curve.at(end))));
}

// Whether two closed pieces of lines have a point in common.
bool meet(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    if ((a.cwiseMax(b).array() < c.cwiseMin(d).array()).any() ||
        (c.cwiseMax(d).array() < a.cwiseMin(b).array()).any())
        return false;
    const auto apart = [](double p, double q) { return (p > 0 && q > 0) || (p < 0 && q < 0); };
    return !apart(cross(b - a, c - a), cross(b - a, d - a)) &&
           !apart(cross(d - c, a - c), cross(d - c, b - c));
}

void check_crossings(const std::vector<ProfileStation>& stations, const Curve& curve,
                     int segments) {
    const std::size_t pieces = stations.size() - 1;
    const auto fail = [&](std::size_t i, std::size_t j) {
        const auto per_span = static_cast<std::size_t>(segments);
        throw InputError(
            fmt::format("the profile meets itself near {}: between points {} and {}, "
                        "and between points {} and {}",
                        place_text(stations[j].at), i / per_span, i / per_span + 1, j / per_span,
                        j / per_span + 1));
    };
    for (std::size_t i = 0; i < pieces; ++i) {
        const Vec2d &a = stations[i].at, &b = stations[i + 1].at;
        for (std::size_t j = i + 2; j < pieces; ++j) {
            const bool around = curve.is_ring() && i == 0 && j + 1 == pieces;
            if (!around && meet(a, b, stations[j].at, stations[j + 1].at)) fail(i, j);
        }
        // The next piece may run back along this one.
        if (i + 1 == pieces && !curve.is_ring()) continue;
        const Vec2d onwards = stations[i + 1 == pieces ? 1 : i + 2].at - b;
        if (cross(b - a, onwards) == 0 && (b - a).dot(onwards) < 0) fail(i, (i + 1) % pieces);
    }
}

}  // namespace

std::vector<ProfileStation> profile_stations(const LatheProfile& profile) {
    check_points(profile);
    const Curve curve(profile);
    check_ends(curve, profile.open);
    if (profile.segments < 1 ||
        curve.spans() > most_pieces / static_cast<std::size_t>(profile.segments))
        throw InputError(fmt::format("the profile has more than {} segments", most_pieces));
    std::vector<ProfileStation> stations;
    for (std::size_t span = 0; span < curve.spans(); ++span)
        for (int k = 0; k <= profile.segments; ++k) {
            const double s = static_cast<double>(k) / profile.segments;
            const Vec2d normal = normal_of(curve.way(span, s));
            if (k == 0 && span > 0)
                stations.back().normal_after = normal;
            else
                stations.push_back({curve.place(span, s), normal, normal, 0});
        }
    for (std::size_t i = 1; i < stations.size(); ++i) {
        const Vec2d& p = stations[i].at;
        if (p.x() <= 0 && i + 1 < stations.size())
            throw InputError("the curve crosses the axis near " + place_text(p));
        stations[i].v = stations[i - 1].v + (p - stations[i - 1].at).norm();
    }
    for (ProfileStation& station : stations) station.v /= stations.back().v;
    stations.back().v = 1;
    check_crossings(stations, curve, profile.segments);
    return stations;
}

}  // namespace caustics

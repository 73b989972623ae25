#include "beamtree/cones/cap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

// Points are on the boundary, not outside, up to here.
constexpr double cap_slack = 1e-14;
constexpr double circle_slack = 1e-12;

// A fixed shuffle: makes the incremental methods linear in expectation.
template <typename Point>
std::vector<Point> shuffled(std::span<const Point> points) {
    std::vector<Point> mixed(points.begin(), points.end());
    Rng rng(1, Stage::beams, mixed.size());
    for (std::size_t i = mixed.size(); i > 1; --i)
        std::swap(mixed[i - 1], mixed[rng.next_word() % i]);
    return mixed;
}

Cap through(const Vec3d& u, const Vec3d& v) {
    const Vec3d sum = u + v;
    if (!(sum.norm() > 0)) return {};
    const Vec3d axis = sum.normalized();
    return {axis, std::min(axis.dot(u), axis.dot(v))};
}

Cap through(const Vec3d& u, const Vec3d& v, const Vec3d& w) {
    Vec3d axis = (v - u).cross(w - u);
    if (!(axis.norm() > 0)) {
        Cap widest = through(u, v);
        for (const Cap& other : {through(u, w), through(v, w)})
            if (other.cosine < widest.cosine) widest = other;
        return widest;
    }
    axis.normalize();
    if (axis.dot(u) < 0) axis = -axis;
    return {axis, std::min({axis.dot(u), axis.dot(v), axis.dot(w)})};
}

Circle through(const Vec2d& a, const Vec2d& b) {
    const Vec2d centre = (a + b) / 2;
    return {centre, std::max((a - centre).norm(), (b - centre).norm())};
}

Circle through(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    const Vec2d u = b - a;
    const Vec2d v = c - a;
    const double twice = 2 * (u.x() * v.y() - u.y() * v.x());
    if (twice == 0) {
        Circle widest = through(a, b);
        for (const Circle& other : {through(a, c), through(b, c)})
            if (other.radius > widest.radius) widest = other;
        return widest;
    }
    const Vec2d centre = a + Vec2d(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(),
                                   u.x() * v.squaredNorm() - v.x() * u.squaredNorm()) /
                                 twice;
    return {centre, std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()})};
}

bool holds(const Cap& cap, const Vec3d& u) { return cap.axis.dot(u) >= cap.cosine - cap_slack; }
bool holds(const Circle& circle, const Vec2d& p) {
    return (p - circle.centre).norm() <= circle.radius * (1 + circle_slack);
}

// The smallest round thing that holds the points: each point outside the one so far lies on the
// boundary of the next.
template <typename Round, typename Point>
Round smallest(const std::vector<Point>& p, Round round) {
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (holds(round, p[i])) continue;
        round = through(p[i], p[i]);
        for (std::size_t j = 0; j < i; ++j) {
            if (holds(round, p[j])) continue;
            round = through(p[i], p[j]);
            for (std::size_t k = 0; k < j; ++k)
                if (!holds(round, p[k])) round = through(p[i], p[j], p[k]);
        }
    }
    return round;
}

// To the farthest of the directions from the axis, so that rounding leaves none outside.
Cap measured(const Vec3d& axis, std::span<const Vec3d> directions) {
    Cap cap{axis, 1};
    for (const Vec3d& u : directions) cap.cosine = std::min(cap.cosine, axis.dot(u));
    return cap;
}

}  // namespace

double Cap::sine() const { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }
double Cap::angle() const { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

Cap box_cap(std::span<const Vec3d> directions) {
    Eigen::AlignedBox3d box;
    for (const Vec3d& u : directions) box.extend(u);
    const Vec3d centre = box.center();
    if (directions.empty() || !(centre.norm() > 1e-9)) return {};
    return measured(centre.normalized(), directions);
}

// [CC95 (1)]
Cap smallest_cap(std::span<const Vec3d> directions) {
    // The method needs a hemisphere: without one its three loops would go on and on.
    const Cap box = box_cap(directions);
    if (box.cosine < 0.05) return box;
    const std::vector<Vec3d> mixed = shuffled(directions);
    return measured(smallest(mixed, through(mixed[0], mixed[0])).axis, directions);
}

Circle smallest_circle(std::span<const Vec2d> points) {
    if (points.empty()) return {};
    const std::vector<Vec2d> mixed = shuffled(points);
    Circle circle = smallest(mixed, Circle{mixed[0], 0});
    for (const Vec2d& p : points)
        circle.radius = std::max(circle.radius, (p - circle.centre).norm());
    return circle;
}

}  // namespace caustics::beamtree

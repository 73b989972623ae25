#include "beamtree/pencils/caster_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/frame.h"

namespace caustics::beamtree {
namespace {

// Cosine of the angle up to which a caster's corners lie round the direction to its middle: else the place is near.
constexpr double widest_cosine = 0.5;
// Rounding of floats, over the rectangle.
constexpr double slack = 1e-5;
constexpr int turns = 8;

// Those faces of a cube round a place that see something of a box.
CasterView faces_that_see(const Vec3d& from, const BoxCorners& corners) {
    CasterView view;
    for (int face = 0; face < 6; ++face) {
        const Vec3d axis = (face % 2 == 0 ? 1 : -1) * Vec3d::Unit(face / 2);
        const Vec3d s = Vec3d::Unit((face / 2 + 1) % 3);
        const Vec3d t = axis.cross(s);
        const auto all_beyond = [&](const Vec3d& side) {
            return std::ranges::all_of(
                corners, [&](const Vec3d& corner) { return (axis - side).dot(corner - from) < 0; });
        };
        if (all_beyond(s) || all_beyond(-s) || all_beyond(t) || all_beyond(-t) ||
            all_beyond(Vec3d::Zero()))
            continue;
        view.rectangles[view.count++] =
            in_space({{s, t}, Vec2d::Constant(-1), Vec2d::Constant(1)}, from + axis);
    }
    return view;
}

}  // namespace

CasterBounds caster_bounds(const Shape& shape) {
    CasterBounds round;
    const Box box = bounds(shape);
    for (int i = 0; i < 8; ++i)
        round.corners[static_cast<std::size_t>(i)] =
            box.corner(static_cast<Box::CornerType>(i)).cast<double>();
    const BoundingSphere sphere = bounding_sphere(shape);
    round.radius =
        static_cast<double>(sphere.radius) + (sphere.centre.cast<double>() - round.middle()).norm();
    return round;
}

void PlaneRectangle::widen() {
    const Vec2d margin = slack * (size() + Vec2d::Constant(size().maxCoeff()));
    low -= margin;
    high += margin;
}

PlaneRectangle rectangle_round(const BoxCorners& points, const Vec3d& normal, double angle) {
    const Frame frame(normal.cast<float>());
    const Vec3d s =
        (frame.s.cast<double>() - normal.dot(frame.s.cast<double>()) * normal).normalized();
    const Vec3d t = normal.cross(s);
    PlaneRectangle turned{.axes = {std::cos(angle) * s + std::sin(angle) * t,
                                   std::cos(angle) * t - std::sin(angle) * s}};
    for (const Vec3d& point : points)
        turned.add({turned.axes[0].dot(point), turned.axes[1].dot(point)});
    turned.widen();
    return turned;
}

double best_turn(const BoxCorners& points, const Vec3d& normal) {
    double best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < turns; ++i) {
        const double angle = i * std::numbers::pi / (2 * turns);
        const double area = rectangle_round(points, normal, angle).area();
        if (!(area < least)) continue;
        best = angle;
        least = area;
    }
    return best;
}

std::optional<BoxCorners> seen_round(const Vec3d& from, const Vec3d& axis,
                                     const BoxCorners& corners) {
    if (!axis.allFinite()) return {};
    BoxCorners seen;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3d way = corners[i] - from;
        if (!(axis.dot(way) > widest_cosine * way.norm())) return {};
        seen[i] = way / axis.dot(way);
    }
    return seen;
}

ViewRectangle in_space(const PlaneRectangle& rectangle, const Vec3d& origin) {
    const auto& [s, t] = rectangle.axes;
    return {origin + rectangle.low.x() * s + rectangle.low.y() * t,
            {rectangle.size().x() * s, rectangle.size().y() * t}};
}

CasterView caster_view(const Vec3d& from, const CasterBounds& caster, std::optional<double> angle) {
    const Vec3d way = caster.middle() - from;
    const double distance = way.norm();
    const Vec3d axis = way / distance;
    const std::optional<BoxCorners> seen = seen_round(from, axis, caster.corners);
    if (!seen) return faces_that_see(from, caster.corners);
    if (!angle) angle = best_turn(*seen, axis);
    PlaneRectangle rectangle = rectangle_round(*seen, axis, *angle);
    if (distance > caster.radius) {
        // The ball's outline is a circle about the axis.
        const double outline =
            caster.radius / std::sqrt(distance * distance - caster.radius * caster.radius);
        const Vec2d reach = Vec2d::Constant((1 + slack) * outline);
        rectangle.low = rectangle.low.cwiseMax(-reach);
        rectangle.high = rectangle.high.cwiseMin(reach);
    }
    CasterView view;
    view.rectangles[view.count++] = in_space(rectangle, from + axis);
    return view;
}

}  // namespace caustics::beamtree

#include "core/geometry/exact_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace caustics {
namespace {

using Hit = std::optional<ExactHit>;

struct Interval {
    double low, high;
    bool holds(double t) const { return t > low && t < high; }
};

Hit intersect_plane(Primitive primitive, const Vec3d& o, const Vec3d& d, Interval range) {
    if (d.z() == 0) return {};
    const double t = -o.z() / d.z();
    if (!range.holds(t)) return {};
    const Vec3d p(o.x() + t * d.x(), o.y() + t * d.y(), 0);
    const bool inside = primitive == Primitive::rectangle
                            ? std::abs(p.x()) <= 1 && std::abs(p.y()) <= 1
                            : p.squaredNorm() <= 1;
    if (!inside) return {};
    return ExactHit{t, p};
}

// Roots of a t^2 + 2 b t + c without cancellation, ascending; empty when not real.
std::optional<std::pair<double, double>> quadratic_roots(double a, double b, double c,
                                                         double discriminant) {
    if (a == 0 || discriminant < 0) return {};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0) return std::pair(0.0, 0.0);
    return std::minmax(q / a, c / q);
}

Hit intersect_sphere(const Vec3d& o, const Vec3d& d, Interval range) {
    const double a = d.squaredNorm();
    const double b = o.dot(d);
    const double c = o.squaredNorm() - 1;
    // The discriminant from the line's closest point to the centre: exact for distant origins.
    const Vec3d closest = o - b / a * d;
    const auto roots = quadratic_roots(a, b, c, a * (1 - closest.squaredNorm()));
    if (!roots) return {};
    for (const double t : {roots->first, roots->second})
        if (range.holds(t)) return ExactHit{t, (o + t * d).normalized()};
    return {};
}

Hit intersect_cylinder(const Vec3d& o, const Vec3d& d, Interval range) {
    const Vec2d o2 = o.head<2>();
    const Vec2d d2 = d.head<2>();
    const double a = d2.squaredNorm();
    if (a == 0) return {};
    const double b = o2.dot(d2);
    const double c = o2.squaredNorm() - 1;
    const Vec2d closest = o2 - b / a * d2;
    const auto roots = quadratic_roots(a, b, c, a * (1 - closest.squaredNorm()));
    if (!roots) return {};
    for (const double t : {roots->first, roots->second}) {
        const double z = o.z() + t * d.z();
        if (!range.holds(t) || z < 0 || z > 1) continue;
        const Vec2d xy = (o2 + t * d2).normalized();
        return ExactHit{t, Vec3d(xy.x(), xy.y(), z)};
    }
    return {};
}

// The part of the range where the ray is inside the heightfield's bounding box.
std::optional<Interval> clip_to_box(const SineHeightfield& field, const Vec3d& o, const Vec3d& d,
                                    Interval range) {
    const double top = field.max_height() + 1e-9;
    const Vec3d half(field.half_size.x(), field.half_size.y(), top);
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0) {
            if (std::abs(o[axis]) > half[axis]) return {};
            continue;
        }
        const auto [enter, leave] =
            std::minmax({(-half[axis] - o[axis]) / d[axis], (half[axis] - o[axis]) / d[axis]});
        range.low = std::max(range.low, enter);
        range.high = std::min(range.high, leave);
    }
    if (range.low > range.high) return {};
    return range;
}

// Marches g(t) = z(t) - h(x(t), y(t)) to its first zero. |g''| <= C bounds how soon g can vanish
// after t: not before the smaller positive root of |g| + s g' sign - C s^2 / 2 = 0, so no step
// passes a zero, and near a simple zero the steps are Newton's. Where rounding does carry the last
// step past the zero, the sign changes. Rays that skim fine ripples take thousands of steps.
Hit intersect_heightfield(const SineHeightfield& field, const Vec3d& o, const Vec3d& d,
                          Interval range) {
    const std::optional<Interval> inside = clip_to_box(field, o, d, range);
    if (!inside) return {};
    const Vec2d d2 = d.head<2>();
    const double curvature = field.max_curvature() * d2.squaredNorm() + 1e-300;
    const double close = 1e-13 * (1 + o.norm() + field.max_height());
    const double least_advance = 1e-15 / d.norm();
    constexpr int max_steps = 1'000'000;
    double t = inside->low;
    bool was_below = false;
    for (int step = 0; step < max_steps && t <= inside->high; ++step) {
        const Vec2d xy = o.head<2>() + t * d2;
        const double g = o.z() + t * d.z() - field.height(xy);
        const bool below = g < 0;
        const double slope = (d.z() - field.gradient(xy).dot(d2)) * (below ? -1 : 1);
        const bool passed = step > 0 && below != was_below;
        if ((std::abs(g) <= close || passed) && range.holds(t))
            return ExactHit{t, Vec3d(xy.x(), xy.y(), field.height(xy))};
        const double root = std::sqrt(slope * slope + 2 * curvature * std::abs(g));
        const double advance =
            slope < 0 ? 2 * std::abs(g) / (root - slope) : (slope + root) / curvature;
        t += std::max({advance, least_advance, 4e-16 * std::abs(t)});
        was_below = below;
    }
    return {};
}

}  // namespace

std::optional<ExactHit> intersect_exact(const Shape& shape, const Vec3d& o, const Vec3d& d,
                                        double t_min, double t_max) {
    const Interval range{t_min, t_max};
    switch (shape.primitive) {
        case Primitive::rectangle:
        case Primitive::disk: return intersect_plane(shape.primitive, o, d, range);
        case Primitive::sphere: return intersect_sphere(o, d, range);
        case Primitive::cylinder: return intersect_cylinder(o, d, range);
        case Primitive::heightfield: return intersect_heightfield(shape.field, o, d, range);
        case Primitive::mesh: break;
    }
    return {};
}

Vec3d exact_normal(const Shape& shape, const Vec3d& local) {
    switch (shape.primitive) {
        case Primitive::sphere: return local.normalized();
        case Primitive::cylinder: return Vec3d(local.x(), local.y(), 0).normalized();
        case Primitive::heightfield: return shape.field.normal(local.head<2>());
        default: return Vec3d::UnitZ();
    }
}

Vec2 exact_uv(const Shape& shape, const Vec3d& local) {
    const auto turns = [](double y, double x) {
        const double angle = std::atan2(y, x) / (2 * pi_d);
        return angle < 0 ? angle + 1 : angle;
    };
    Vec2d uv = (local.head<2>() + Vec2d::Ones()) / 2;
    switch (shape.primitive) {
        case Primitive::disk: uv = {local.head<2>().norm(), turns(local.y(), local.x())}; break;
        case Primitive::sphere:
            uv = {turns(local.y(), local.x()), std::acos(std::clamp(local.z(), -1.0, 1.0)) / pi_d};
            break;
        case Primitive::cylinder: uv = {turns(local.y(), local.x()), local.z()}; break;
        case Primitive::heightfield:
            uv = (local.head<2>().cwiseQuotient(shape.field.half_size) + Vec2d::Ones()) / 2;
            break;
        default: break;
    }
    return uv.cast<float>();
}

double exact_area_element(const Shape& shape, const Vec2d& uv) {
    const double turn = 2 * pi_d;
    const auto around = [&](double turns) {
        return Vec3d(std::cos(turn * turns), std::sin(turn * turns), 0);
    };
    const auto along = [&](double turns) {
        return Vec3d(-turn * std::sin(turn * turns), turn * std::cos(turn * turns), 0);
    };
    Vec3d du(2, 0, 0), dv(0, 2, 0);
    switch (shape.primitive) {
        case Primitive::disk:
            du = around(uv.y());
            dv = uv.x() * along(uv.y());
            break;
        case Primitive::sphere: {
            const double polar = pi_d * uv.y();
            du = std::sin(polar) * along(uv.x());
            dv = pi_d * (std::cos(polar) * around(uv.x()) - std::sin(polar) * Vec3d::UnitZ());
            break;
        }
        case Primitive::cylinder:
            du = along(uv.x());
            dv = Vec3d::UnitZ();
            break;
        case Primitive::heightfield: {
            const Vec2d half = shape.field.half_size;
            const Vec2d slope = shape.field.gradient(half.cwiseProduct(2 * uv - Vec2d::Ones()));
            du = 2 * half.x() * Vec3d(1, 0, slope.x());
            dv = 2 * half.y() * Vec3d(0, 1, slope.y());
            break;
        }
        default: break;
    }
    return (shape.to_world.linear() * du).cross(shape.to_world.linear() * dv).norm();
}

}  // namespace caustics

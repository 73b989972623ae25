#include "core/exact_shapes/exact_hit.h"

#include <algorithm>
#include <cmath>

namespace caustics {
namespace {

constexpr double turn = 2 * pi_d;

}  // namespace

std::optional<ExactHit> hit_of_plane(const Vec3d& o, const Vec3d& d, RayInterval range) {
    if (d.z() == 0) return {};
    const double t = -o.z() / d.z();
    if (!range.holds(t)) return {};
    return ExactHit{t, Vec3d(o.x() + t * d.x(), o.y() + t * d.y(), 0)};
}

std::optional<std::pair<double, double>> quadratic_roots(double a, double b, double c,
                                                         double discriminant) {
    if (a == 0 || discriminant < 0) return {};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0) return std::pair(0.0, 0.0);
    return std::minmax(q / a, c / q);
}

double turns_of(const Vec2d& xy) {
    const double angle = std::atan2(xy.y(), xy.x()) / turn;
    return angle < 0 ? angle + 1 : angle;
}

Vec3d at_turns(double turns) { return {std::cos(turn * turns), std::sin(turn * turns), 0}; }

Vec3d along_turns(double turns) {
    return {-turn * std::sin(turn * turns), turn * std::cos(turn * turns), 0};
}

std::vector<Vec3d> sector_hull(double from, double to, double r0, double height) {
    const double middle = (from + to) / 2;
    const double tangent = 1 / std::cos((to - from) / 2);
    std::vector<Vec3d> corners;
    for (const double z : {0.0, height})
        for (const Vec2d& p :
             {Vec2d(std::cos(from), std::sin(from)), Vec2d(std::cos(to), std::sin(to)),
              Vec2d(tangent * std::cos(middle), tangent * std::sin(middle)),
              Vec2d(r0 * std::cos(from), r0 * std::sin(from)),
              Vec2d(r0 * std::cos(to), r0 * std::sin(to))})
            corners.emplace_back(p.x(), p.y(), z);
    return corners;
}

}  // namespace caustics

#include "core/exact_shapes/heightfield.h"

#include <algorithm>
#include <cmath>

#include "core/mesh/mesh_rows.h"

namespace caustics {

double SineHeightfield::height(const Vec2d& xy) const {
    double sum = 0;
    for (const SineWave& wave : waves)
        sum += wave.amplitude * std::sin(wave.wave_vector.dot(xy) + wave.phase);
    return sum;
}

Vec2d SineHeightfield::gradient(const Vec2d& xy) const {
    Vec2d sum = Vec2d::Zero();
    for (const SineWave& wave : waves)
        sum += wave.amplitude * std::cos(wave.wave_vector.dot(xy) + wave.phase) * wave.wave_vector;
    return sum;
}

Vec3d SineHeightfield::normal(const Vec2d& xy) const {
    const Vec2d slope = gradient(xy);
    return Vec3d(-slope.x(), -slope.y(), 1).normalized();
}

double SineHeightfield::max_height() const {
    double sum = 0;
    for (const SineWave& wave : waves) sum += std::abs(wave.amplitude);
    return sum;
}

double SineHeightfield::max_curvature() const {
    double sum = 0;
    for (const SineWave& wave : waves)
        sum += std::abs(wave.amplitude) * wave.wave_vector.squaredNorm();
    return sum;
}

TriangleMesh tessellate_heightfield(const SineHeightfield& field, Cells n) {
    check_resolution(n);
    TriangleMesh mesh;
    for (int j = 0; j <= n.y; ++j)
        for (int i = 0; i <= n.x; ++i) {
            const Vec2d xy(symmetric(i, n.x) * field.half_size.x(),
                           symmetric(j, n.y) * field.half_size.y());
            add_vertex(mesh, {xy.x(), xy.y(), field.height(xy)}, field.normal(xy),
                       {fraction(i, n.x), fraction(j, n.y)});
        }
    add_grid_triangles(mesh, 0, n.x, n.y);
    return mesh;
}

namespace {

// The part of the range where the ray is inside the heightfield's bounding box.
std::optional<RayInterval> clip_to_box(const SineHeightfield& field, const Vec3d& o, const Vec3d& d,
                                       RayInterval range) {
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

}  // namespace

// Marches g(t) = z(t) - h(x(t), y(t)) to its first zero. |g''| <= C bounds how soon g can vanish
// after t: not before the smaller positive root of |g| + s g' sign - C s^2 / 2 = 0, so no step
// passes a zero, and near a simple zero the steps are Newton's. Where rounding does carry the last
// step past the zero, the sign changes. Rays that skim fine ripples take thousands of steps.
std::optional<ExactHit> Heightfield::intersect(const Vec3d& o, const Vec3d& d,
                                               RayInterval range) const {
    const std::optional<RayInterval> inside = clip_to_box(field, o, d, range);
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

Vec2d Heightfield::uv(const Vec3d& p) const {
    return (p.head<2>().cwiseQuotient(field.half_size) + Vec2d::Ones()) / 2;
}

std::pair<Vec3d, Vec3d> Heightfield::tangents(const Vec2d& uv) const {
    const Vec2d half = field.half_size;
    const Vec2d slope = field.gradient(half.cwiseProduct(2 * uv - Vec2d::Ones()));
    return {2 * half.x() * Vec3d(1, 0, slope.x()), 2 * half.y() * Vec3d(0, 1, slope.y())};
}

double Heightfield::feature_size() const {
    double size = field.half_size.minCoeff();
    for (const SineWave& wave : field.waves)
        size = std::min(size, 1 / std::max(wave.wave_vector.norm(), 1e-300));
    return size;
}

Eigen::AlignedBox3d Heightfield::bounds() const {
    const Vec2d half = field.half_size;
    const double top = field.max_height();
    return {Vec3d(-half.x(), -half.y(), -top), Vec3d(half.x(), half.y(), top)};
}

}  // namespace caustics

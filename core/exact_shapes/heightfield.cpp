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

Vec2d SineHeightfield::gradient_change(const Vec2d& xy, const Vec2d& way) const {
    Vec2d sum = Vec2d::Zero();
    for (const SineWave& wave : waves)
        sum -= wave.amplitude * std::sin(wave.wave_vector.dot(xy) + wave.phase) *
               wave.wave_vector.dot(way) * wave.wave_vector;
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
    expect_grid(mesh, n.x, n.y);
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

namespace {

/// Along a ray: the height above the surface, g(t) = z(t) - h(x(t), y(t)), and its derivative.
class AboveSurface {
public:
    AboveSurface(const SineHeightfield& field, const Vec3d& o, const Vec3d& d)
        : field_(field),
          o_(o),
          d_(d),
          curvature_(field.max_curvature() * d.head<2>().squaredNorm() + 1e-300),
          least_advance_(1e-15 / d.norm()) {}

    Vec2d xy(double t) const { return o_.head<2>() + t * d_.head<2>(); }
    double at(double t) const { return o_.z() + t * d_.z() - field_.height(xy(t)); }
    /// How far g cannot vanish from t on, where it is `g`: |g''| <= C, so not before the smaller positive root of
    /// |g| + s g' sign - C s^2 / 2 = 0. Near a simple zero these steps are Newton's.
    double safe_step(double t, double g) const {
        const double slope = (d_.z() - field_.gradient(xy(t)).dot(d_.head<2>())) * (g < 0 ? -1 : 1);
        const double root = std::sqrt(slope * slope + 2 * curvature_ * std::abs(g));
        return slope < 0 ? 2 * std::abs(g) / (root - slope) : (slope + root) / curvature_;
    }
    /// A 64th of the fastest wave along the ray.
    double stride() const {
        double fastest = 1e-300;
        for (const SineWave& wave : field_.waves)
            fastest = std::max(fastest, std::abs(wave.wave_vector.dot(d_.head<2>())));
        return 2 * pi_d / (64 * fastest);
    }
    double least(double t) const { return std::max(least_advance_, 4e-16 * std::abs(t)); }
    /// Where the sign changes between two places.
    double zero_between(double from, double to) const {
        const bool below = at(from) < 0;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = (from + to) / 2;
            ((at(middle) < 0) == below ? from : to) = middle;
        }
        return to;
    }

private:
    const SineHeightfield& field_;
    const Vec3d& o_;
    const Vec3d& d_;
    double curvature_;
    double least_advance_;
};

}  // namespace

// Marches to the first zero by steps that pass none. Where rounding does carry the last step past the zero, the
// sign changes. Rays that skim fine ripples take thousands of steps, and those along waves that cancel each other
// as many as one likes: after a million it strides on, passing over dips of less than a 64th of a wave only.
std::optional<ExactHit> Heightfield::intersect(const Vec3d& o, const Vec3d& d,
                                               RayInterval range) const {
    const std::optional<RayInterval> inside = clip_to_box(field, o, d, range);
    if (!inside) return {};
    const AboveSurface above(field, o, d);
    const double close = 1e-13 * (1 + o.norm() + field.max_height());
    constexpr int most_safe_steps = 1'000'000;
    bool was_below = false;
    double stride = 0;
    double before = inside->low;
    double t = inside->low;
    for (int step = 0; t <= inside->high; ++step) {
        const double g = above.at(t);
        const bool below = g < 0;
        const bool passed = step > 0 && below != was_below;
        if ((std::abs(g) <= close || passed) && range.holds(t)) {
            if (passed && step > most_safe_steps) t = above.zero_between(before, t);
            const Vec2d xy = above.xy(t);
            return ExactHit{t, Vec3d(xy.x(), xy.y(), field.height(xy))};
        }
        if (step == most_safe_steps) stride = above.stride();
        const double advance = step < most_safe_steps ? above.safe_step(t, g) : stride;
        before = t;
        t += std::max(advance, above.least(t));
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

Vec3d Heightfield::onto_change(const Vec3d& p, const Vec3d& way) const {
    return {way.x(), way.y(), field.gradient(p.head<2>()).dot(way.head<2>())};
}

Vec3d Heightfield::normal_change(const Vec3d& on, const Vec3d& way) const {
    const Vec2d slope = field.gradient(on.head<2>());
    const Vec2d turned = field.gradient_change(on.head<2>(), way.head<2>());
    const Vec3d up(-slope.x(), -slope.y(), 1);
    const double length = up.norm();
    const Vec3d n = up / length;
    const Vec3d change(-turned.x(), -turned.y(), 0);
    return (change - n.dot(change) * n) / length;
}

Eigen::AlignedBox3d Heightfield::bounds() const {
    const Vec2d half = field.half_size;
    const double top = field.max_height();
    return {Vec3d(-half.x(), -half.y(), -top), Vec3d(half.x(), half.y(), top)};
}

}  // namespace caustics

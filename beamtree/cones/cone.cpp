#include "beamtree/cones/cone.h"

#include <algorithm>
#include <cmath>

namespace caustics::beamtree {
namespace {

// Bounds are kept in float and asked in double: these cover their rounding.
constexpr float widen = 1e-6F;
constexpr float turn = 1e-6F;

float rounded_down_cosine(double cosine) { return static_cast<float>(cosine) - 2e-7F; }
float rounded_up_sine(double sine) { return std::min(1.0F, static_cast<float>(sine) + turn); }

Eigen::AlignedBox3d box_of_rays(const NodeRays& rays) {
    Eigen::AlignedBox3d box;
    for (const Vec3d& p : rays.positions) box.extend(p);
    return box;
}

float size_of(const Eigen::AlignedBox3d& box) {
    return static_cast<float>(box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff());
}

}  // namespace

SweptSphere::SweptSphere(const NodeRays& rays, const Cap& cap)
    : axis(cap.axis.cast<float>()),
      cosine(rounded_down_cosine(cap.cosine)),
      sine(rounded_up_sine(cap.sine())) {
    const Eigen::AlignedBox3d box = box_of_rays(rays);
    centre = Vec3d(box.center()).cast<float>();
    double farthest = 0;
    double least = 0;
    for (const Vec3d& p : rays.positions) {
        const Vec3d from_centre = p - centre.cast<double>();
        farthest = std::max(farthest, from_centre.norm());
        least = std::min(least, from_centre.dot(axis.cast<double>()));
    }
    const float rounding = widen * size_of(box);
    radius = static_cast<float>(farthest) * (1 + widen) + rounding;
    nearest = static_cast<float>(least) * (1 + widen) - rounding;
}

bool SweptSphere::holds(const Vec3d& p) const {
    if (cosine <= 0) return true;
    const Vec3d v = p - centre.cast<double>();
    const double x = v.dot(axis.cast<double>());
    const double across = v.squaredNorm() - x * x;
    const double w = static_cast<double>(radius) + x * static_cast<double>(sine);
    const double c = static_cast<double>(cosine);
    // The axis is a unit vector to float only.
    return w >= 0 && x >= static_cast<double>(nearest) - 1e-6 * v.norm() &&
           across * c * c <= w * w + 4e-7 * v.squaredNorm();
}

SingleCone::SingleCone(const NodeRays& rays, const Cap& cap)
    : axis(cap.axis.cast<float>()),
      cosine(rounded_down_cosine(cap.cosine)),
      sine(rounded_up_sine(cap.sine())) {
    const Eigen::AlignedBox3d box = box_of_rays(rays);
    const Vec3 rounding = Vec3::Constant(widen * size_of(box));
    low = Vec3d(box.min()).cast<float>() - rounding;
    high = Vec3d(box.max()).cast<float>() + rounding;
}

bool SingleCone::holds(const Vec3d& p) const {
    std::array<Vec3d, 8> corners;
    for (std::size_t i = 0; i < 8; ++i)
        for (int axis_index = 0; axis_index < 3; ++axis_index)
            corners[i][axis_index] = static_cast<double>(
                ((i >> static_cast<unsigned>(axis_index)) & 1U) != 0 ? high[axis_index]
                                                                     : low[axis_index]);
    return holds(p, corners);
}

bool SingleCone::holds(const Vec3d& p, std::span<const Vec3d> from) const {
    if (cosine <= 0) return true;
    std::array<Vec3d, 8> directions;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3d d = p - from[i];
        const double length = d.norm();
        if (!(length > 0)) return true;
        directions[i] = d / length;
    }
    const Cap seen = box_cap(std::span(directions).first(from.size()));
    if (seen.is_wide()) return true;
    const auto c = static_cast<double>(cosine);
    const auto s = static_cast<double>(sine);
    // Both angles are below 90 degrees: they overlap where the axes' angle is at most their sum.
    const double together = c * seen.cosine - s * seen.sine();
    return axis.cast<double>().dot(seen.axis) >= together - 2e-6;
}

std::optional<bool> DoubleCone::holds(const Vec3d& p, const Vec3d& plane_normal) const {
    const Vec3d a = axis.cast<double>();
    const double down = -plane_normal.dot(a) / plane_normal.norm();
    if (down < 0.02) return {};
    const double tilt = std::sqrt(std::max(0.0, 1 - down * down)) / down;
    const auto slope = static_cast<double>(tangent);
    const auto spread = static_cast<double>(spreading);
    // Rays that may run along the plane have no caustic polygon of bounded size on it.
    const double steep = tilt * (spread + slope);
    if (steep > 0.99) return {};
    const Vec3d v = p - neck.cast<double>();
    const double x = v.dot(a);
    const double rounding = 1e-6 * v.norm();
    if (x < static_cast<double>(nearest) - rounding) return false;
    const double y = (v - x * a).norm();
    // A point of the caustic polygon is a mean of ray points at different depths: off the mean at
    // its own depth by the covariance of depth and slope, at most range(depth) / 2 times
    // diameter(slopes) / sqrt(3); the depths differ by tilt times the polygon's width.
    const double beam_width = (static_cast<double>(width) + std::abs(x) * spread) / (1 - steep);
    const double slack = 0.289 * tilt * beam_width * spread;
    return y <= static_cast<double>(radius) + std::abs(x) * slope + slack + rounding;
}

}  // namespace caustics::beamtree

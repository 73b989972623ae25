#include "core/camera.h"

#include <algorithm>
#include <cmath>

namespace caustics {

Vec2d Camera::half_extent() const {
    const double aspect = static_cast<double>(width) / height;
    const double tangent = std::tan(fov_degrees * pi_d / 360);
    FovAxis axis = fov_axis;
    if (axis == FovAxis::smaller) axis = aspect > 1 ? FovAxis::y : FovAxis::x;
    if (axis == FovAxis::larger) axis = aspect > 1 ? FovAxis::x : FovAxis::y;
    switch (axis) {
        case FovAxis::y: return {tangent * aspect, tangent};
        case FovAxis::diagonal: {
            const double half_height = tangent / std::sqrt(1 + aspect * aspect);
            return {half_height * aspect, half_height};
        }
        default: return {tangent, tangent / aspect};
    }
}

Vec3 Camera::position() const { return Vec3d(to_world.translation()).cast<float>(); }

Vec3 Camera::direction(double x, double y) const {
    const Vec2d half = half_extent();
    const Vec3d local(half.x() * (1 - 2 * x / width), half.y() * (1 - 2 * y / height), 1);
    return Vec3d(to_world.linear() * local).normalized().cast<float>();
}

std::optional<Camera::Projection> Camera::project(const Vec3& p) const {
    const Vec3d local = to_world.inverse() * p.cast<double>();
    if (local.z() <= 0) return {};
    const Vec2d half = half_extent();
    Projection projection{};
    projection.x = (1 - local.x() / local.z() / half.x()) / 2 * width;
    projection.y = (1 - local.y() / local.z() / half.y()) / 2 * height;
    if (projection.x < 0 || projection.x >= width || projection.y < 0 || projection.y >= height)
        return {};
    projection.cos_theta = local.z() / local.norm();
    projection.distance = (p.cast<double>() - to_world.translation()).norm();
    return projection;
}

double Camera::pixel_area() const {
    const Vec2d half = half_extent();
    return 4 * half.x() * half.y() / (static_cast<double>(width) * height);
}

}  // namespace caustics

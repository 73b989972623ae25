#include "core/scene/camera.h"

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

Vec3d Camera::towards(double x, double y) const {
    const Vec2d half = half_extent();
    const Vec3d local(half.x() * (1 - 2 * x / width), half.y() * (1 - 2 * y / height), 1);
    return to_world.linear() * local;
}

Vec3 Camera::direction(double x, double y) const {
    return towards(x, y).normalized().cast<float>();
}

double Camera::pixel_area() const {
    const Vec2d half = half_extent();
    return 4 * half.x() * half.y() / (static_cast<double>(width) * height);
}

FilmProjection::FilmProjection(const Camera& camera)
    : to_local_(camera.to_world.inverse()),
      eye_(camera.to_world.translation()),
      half_extent_(camera.half_extent()),
      pixel_area_(camera.pixel_area()),
      width_(camera.width),
      height_(camera.height) {}

std::optional<FilmProjection::Seen> FilmProjection::project(const Vec3& p) const {
    const Vec3d local = to_local_ * p.cast<double>();
    if (local.z() <= 0) return {};
    Seen seen{};
    seen.x = (1 - local.x() / local.z() / half_extent_.x()) / 2 * width_;
    seen.y = (1 - local.y() / local.z() / half_extent_.y()) / 2 * height_;
    if (seen.x < 0 || seen.x >= width_ || seen.y < 0 || seen.y >= height_) return {};
    seen.cos_theta = local.z() / local.norm();
    seen.distance = (p.cast<double>() - eye_).norm();
    return seen;
}

}  // namespace caustics

#include "beamtree/light/image_model.h"

#include <algorithm>
#include <limits>

#include "beamtree/light/projected.h"

namespace caustics::beamtree {
namespace {

// Rays flatter to the plane have no image on it.
constexpr double least_steep = 0.05;
constexpr int most_model_steps = 14;
constexpr double longest_model_step = 0.5;  // of the polygon's sides
// How far beyond the polygon a solution may lie, and a ray that reaches the point still leave the polygon.
constexpr double model_reach = 0.3;
// The largest distance of the image from its model, over its bulge.
constexpr double model_error = 0.25;
constexpr double model_error_in_part = 1;
constexpr double same_solution = 1e-3;

// Places all over a polygon.
constexpr std::array<std::array<double, 2>, 7> places = {
    {{0.05, 0.05}, {0.9, 0.05}, {0.05, 0.9}, {0.5, 0.05}, {0.45, 0.5}, {0.05, 0.45}, {0.33, 0.33}}};

// The place of the polygon at, or near, these coordinates.
Vec2d clamped(const Vec2d& at) {
    const Vec3d weights = Vec3d(1 - at.x() - at.y(), at.x(), at.y()).cwiseMax(0);
    return weights.tail<2>() / weights.sum();
}

}  // namespace

std::optional<ArrivalPlane> ArrivalPlane::at(const Vec3& point,
                                             const std::array<const VertexRay*, 3>& rays) {
    const Vec3 mean = rays[0]->direction + rays[1]->direction + rays[2]->direction;
    if (mean.isZero(0)) return {};
    return ArrivalPlane(point.cast<double>(), mean.cast<double>().normalized());
}

ArrivalPlane::ArrivalPlane(const Vec3d& point, const Vec3d& direction)
    : point_(point), direction_(direction) {
    across_[0] = direction.unitOrthogonal();
    across_[1] = direction.cross(across_[0]);
}

Eigen::Matrix2d ArrivalPlane::miss_change(const ChainRay& ray) const {
    Eigen::Matrix2d change;
    const double along = way(ray.position, ray.direction);
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3d moved = ray.by_position[i] + along * ray.by_direction[i];
        change.col(static_cast<Eigen::Index>(i)) =
            on_plane(moved - direction_.dot(moved) / steepness(ray.direction) * ray.direction);
    }
    return change;
}

std::optional<ImageModel> ImageModel::of(const ArrivalPlane& plane,
                                         const std::array<const VertexRay*, 3>& corners,
                                         const EdgeMiddles& middles, bool has_dark_part) {
    std::array<Vec2d, 6> misses;
    bool arrives = false;
    for (std::size_t i = 0; i < 6; ++i) {
        const VertexRay& ray = i < 3 ? *corners[i] : middles[i - 3];
        const Vec3d position = ray.position.cast<double>();
        const Vec3d direction = ray.direction.cast<double>();
        if (!(plane.steepness(direction) > least_steep)) return {};
        misses[i] = plane.miss(position, direction);
        arrives = arrives || plane.way(position, direction) > 0;
    }
    if (!arrives) return {};
    ImageModel model(misses);
    if (!model.may_hold(has_dark_part ? model_error_in_part : model_error)) return {};
    model.find_areas();
    return model;
}

ImageModel::ImageModel(const std::array<Vec2d, 6>& misses) : misses_(misses) {
    for (std::size_t i = 0; i < 3; ++i) {
        bulges_[i] = misses[3 + i] - (misses[i] + misses[(i + 1) % 3]) / 2;
        bulge_ = std::max(bulge_, bulges_[i].norm());
    }
    uu_ = -4 * bulges_[0];
    vv_ = -4 * bulges_[2];
    u_ = misses[1] - misses[0] - uu_;
    v_ = misses[2] - misses[0] - vv_;
    uv_ = 4 * (misses[4] - misses[0]) - 2 * (u_ + v_) - uu_ - vv_;
}

// A quadratic lies in the hull of its Bezier points: the corners, and for each edge its middle moved on by the bulge.
bool ImageModel::may_hold(double error) const {
    Vec2d low = misses_[0];
    Vec2d high = misses_[0];
    for (std::size_t i = 0; i < 3; ++i)
        for (const Vec2d& at : {misses_[i], Vec2d(misses_[3 + i] + bulges_[i])}) {
            low = low.cwiseMin(at);
            high = high.cwiseMax(at);
        }
    const double room = error * bulge_;
    return (low.array() <= room).all() && (high.array() >= -room).all();
}

Vec2d ImageModel::miss(const Vec2d& at) const {
    return misses_[0] + at.x() * (u_ + at.x() * uu_ + at.y() * uv_) + at.y() * (v_ + at.y() * vv_);
}

Eigen::Matrix2d ImageModel::change(const Vec2d& at) const {
    Eigen::Matrix2d change;
    change.col(0) = u_ + 2 * at.x() * uu_ + at.y() * uv_;
    change.col(1) = v_ + at.x() * uv_ + 2 * at.y() * vv_;
    return change;
}

void ImageModel::find_areas() {
    least_area_ = std::numeric_limits<double>::infinity();
    most_area_ = -least_area_;
    for (const auto& [u, v] : places) {
        const double area = change({u, v}).determinant();
        least_area_ = std::min(least_area_, area);
        most_area_ = std::max(most_area_, area);
    }
}

bool ImageModel::folds() const {
    constexpr double nearly = 0.05;
    return !(least_area_ > nearly * most_area_ || most_area_ < nearly * least_area_);
}

bool ImageModel::is_beside_fold(double area) const {
    constexpr double near = 0.3;
    return folds() || std::abs(area) < near * std::max(std::abs(least_area_), std::abs(most_area_));
}

bool ImageModel::is_uneven() const {
    constexpr double even = 0.5;
    return !(least_area_ > even * most_area_ || most_area_ < even * least_area_);
}

// The point's coordinates in the straight-sided image; the polygon's middle where that has no area.
Vec2d ImageModel::straight() const {
    Eigen::Matrix2d sides;
    sides << misses_[1] - misses_[0], misses_[2] - misses_[0];
    const Vec2d at = sides.inverse() * -misses_[0];
    return at.allFinite() ? at : Vec2d(1.0 / 3, 1.0 / 3);
}

// By Newton's method.
Vec2d ImageModel::solve(Vec2d at) const {
    for (int step = 0; step < most_model_steps; ++step) {
        const Vec2d by = change(at).inverse() * miss(at);
        const double length = by.norm();
        if (!(length < std::numeric_limits<double>::infinity())) return at;
        at -= std::min(1.0, longest_model_step / length) * by;
        if (length < 1e-6) return at;
    }
    return at;
}

ImageModel::Solutions ImageModel::everywhere() {
    Solutions all;
    for (const auto& [u, v] : places) all.at[all.count++] = {u, v};
    return all;
}

ImageModel::Solutions ImageModel::solutions() const {
    Solutions found;
    const double size = (misses_[1] - misses_[0]).norm() + (misses_[2] - misses_[0]).norm();
    // Beside a fold the model may pass the point where the image does not.
    std::optional<Vec2d> nearest;
    double least_miss = bulge_;
    const auto try_from = [&](const Vec2d& from) {
        const Vec2d at = solve(from);
        if (!(least_weight(at) >= -model_reach)) return;
        const double missed = miss(at).norm();
        if (!(missed <= model_error * bulge_ + 1e-6 * size)) {
            if (missed < least_miss) nearest = at;
            least_miss = std::min(least_miss, missed);
            return;
        }
        for (const Vec2d& other : found)
            if ((other - at).norm() < same_solution) return;
        found.at[found.count++] = at;
    };
    if (!folds())
        try_from(clamped(straight()));
    else
        for (const auto& [u, v] : places) try_from({u, v});
    if (found.count == 0 && nearest) found.at[found.count++] = *nearest;
    return found;
}

bool ImageModel::surely_holds() const {
    constexpr double bulges_inside = 1.5;
    const double area = cross(misses_[1] - misses_[0], misses_[2] - misses_[0]);
    const double turn = area < 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d& a = misses_[i];
        const Vec2d& b = misses_[(i + 1) % 3];
        if (!(turn * cross(a, b) > bulges_inside * bulge_ * (b - a).norm())) return false;
    }
    return area != 0;
}

// By the same hull, in those two of the scene's coordinates along which the plane is steepest.
bool may_have_image(const Vec3& point, const std::array<const VertexRay*, 3>& corners,
                    const EdgeMiddles& middles, bool has_dark_part) {
    constexpr float rounding = 1e-5F;  // of the way to the plane
    const Vec3 across = corners[0]->direction + corners[1]->direction + corners[2]->direction;
    Eigen::Index left_out = 0;
    across.cwiseAbs().maxCoeff(&left_out);
    const Eigen::Index u = (left_out + 1) % 3;
    const Eigen::Index v = (left_out + 2) % 3;
    const float least = static_cast<float>(least_steep) * across.norm();
    std::array<Vec2, 6> misses;
    float farthest = 0;
    bool arrives = false;
    for (std::size_t i = 0; i < 6; ++i) {
        const VertexRay& ray = i < 3 ? *corners[i] : middles[i - 3];
        const float steepness = across.dot(ray.direction);
        if (!(steepness > least * (1 - rounding))) return false;
        const Vec3 from = ray.position - point;
        const float way = -across.dot(from) / steepness;
        misses[i] = {from[u] + way * ray.direction[u], from[v] + way * ray.direction[v]};
        farthest = std::max(farthest, std::abs(way));
        arrives = arrives || way > -rounding * from.norm();
    }
    if (!arrives) return false;
    Vec2 low = misses[0];
    Vec2 high = misses[0];
    Vec2 bulge = Vec2::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 off = misses[3 + i] - (misses[i] + misses[(i + 1) % 3]) / 2;
        const Vec2 control = misses[3 + i] + off;
        low = low.cwiseMin(misses[i]).cwiseMin(control);
        high = high.cwiseMax(misses[i]).cwiseMax(control);
        bulge = bulge.cwiseMax(off.cwiseAbs());
    }
    const auto error = static_cast<float>(has_dark_part ? model_error_in_part : model_error);
    const Vec2 room = error * bulge + Vec2::Constant(rounding * farthest);
    return (low.array() <= room.array()).all() && (high.array() >= -room.array()).all();
}

}  // namespace caustics::beamtree

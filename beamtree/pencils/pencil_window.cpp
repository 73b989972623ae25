#include "beamtree/pencils/pencil_window.h"

#include <cmath>

namespace caustics::beamtree {
namespace {

/// A convex polygon in numbers along a pencil's sides.
struct Outline {
    std::array<Vec2d, 8> corners;
    std::size_t count = 0;

    const Vec2d& after(std::size_t i) const { return corners[i + 1 < count ? i + 1 : 0]; }
    // Keeps what lies on the pencil's side of an edge of its, sign * p[axis] <= 1 / 2.
    void cut(Eigen::Index axis, double sign) {
        Outline kept;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec2d& a = corners[i];
            const Vec2d& b = after(i);
            const double beyond_a = sign * a[axis] - 0.5;
            const double beyond_b = sign * b[axis] - 0.5;
            if (beyond_a <= 0) kept.corners[kept.count++] = a;
            if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
                kept.corners[kept.count++] = a + beyond_a / (beyond_a - beyond_b) * (b - a);
        }
        *this = kept;
    }
    double area() const {
        double twice = 0;
        for (std::size_t i = 0; i < count; ++i)
            twice += corners[i].x() * after(i).y() - corners[i].y() * after(i).x();
        return std::abs(twice) / 2;
    }
};

}  // namespace

PencilWindow::PencilWindow(const ReceiverPoint& point) : position_(point.position) {
    if (point.cell == nullptr) return;
    Outline outline;
    for (std::size_t i = 0; i < 4; ++i) {
        corners_[i] = point.cell->corner(i).cast<float>();
        outline.corners[outline.count++] = point.cell->corners[i];
    }
    area_ = outline.area();
    if (area_ > 0) radius_ = static_cast<float>(point.cell->radius);
}

double PencilWindow::density(const Vec2& at, const std::array<Vec3, 2>& by_side, double area,
                             double cosine) const {
    constexpr float half = 0.5F;
    if (!(radius_ > 0)) return at.cwiseAbs().maxCoeff() <= half ? cosine / area : 0;
    std::array<Vec2, 4> corners;
    Vec2 low = at;
    Vec2 high = at;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = at + Vec2(by_side[0].dot(corners_[i]), by_side[1].dot(corners_[i]));
        low = low.cwiseMin(corners[i]);
        high = high.cwiseMax(corners[i]);
    }
    if (low.maxCoeff() >= half || high.minCoeff() <= -half) return 0;
    if (low.minCoeff() >= -half && high.maxCoeff() <= half) return cosine / area;
    Outline cell;
    for (const Vec2& corner : corners) cell.corners[cell.count++] = corner.cast<double>();
    for (const Eigen::Index axis : {0, 1})
        for (const double sign : {1.0, -1.0}) cell.cut(axis, sign);
    return cell.area() / area_;
}

}  // namespace caustics::beamtree

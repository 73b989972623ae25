#include "tests/agreement/brute_force_roots.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace caustics {
namespace {

constexpr int most_steps = 30;
constexpr double step = 1e-6;       // of differences
constexpr double tolerance = 1e-9;  // of landings [m]

/// The points of the floor in square bins.
class Bins {
public:
    explicit Bins(const std::vector<Vec2d>& points) : points_(points) {
        for (const Vec2d& p : points) box_.extend(p);
        side_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(points.size())));
        bins_.resize(side_ * side_);
        for (std::size_t i = 0; i < points.size(); ++i)
            bins_[bin(0, points[i].x()) + side_ * bin(1, points[i].y())].push_back(i);
    }

    template <typename Visit>
    void each_inside(const Eigen::AlignedBox2d& box, const Visit& visit) const {
        if (!box.intersects(box_)) return;
        for (std::size_t y = bin(1, box.min().y()); y <= bin(1, box.max().y()); ++y)
            for (std::size_t x = bin(0, box.min().x()); x <= bin(0, box.max().x()); ++x)
                for (const std::size_t i : bins_[x + side_ * y])
                    if (box.contains(points_[i])) visit(i);
    }

private:
    std::size_t bin(Eigen::Index axis, double at) const {
        const double share =
            (at - box_.min()[axis]) / std::max(1e-12, box_.max()[axis] - box_.min()[axis]);
        return std::min(
            side_ - 1, static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(side_)));
    }

    const std::vector<Vec2d>& points_;
    Eigen::AlignedBox2d box_;
    std::size_t side_;
    std::vector<std::vector<std::size_t>> bins_;
};

std::optional<Eigen::Matrix2d> change_at(const RayMap& map, const Vec2d& at) {
    Eigen::Matrix2d change;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const auto more = map(at + step * Vec2d::Unit(i));
        const auto less = map(at - step * Vec2d::Unit(i));
        if (!more || !less) return {};
        change.col(i) = (more->floor - less->floor) / (2 * step);
    }
    return change;
}

/// The rays of one map that were found.
struct Found {
    std::vector<std::vector<Vec2d>> places;  ///< one list a point
    std::vector<LightAtPoint>& light;

    void polish(const RayMap& map, Vec2d at, std::size_t point, const Vec2d& target,
                double longest) {
        for (int i = 0; i < most_steps; ++i) {
            const auto ray = map(at);
            const auto change = ray ? change_at(map, at) : std::nullopt;
            if (!change) return;
            const Vec2d miss = ray->floor - target;
            if (miss.norm() < tolerance) return add(at, point, *ray, *change);
            const Vec2d by = change->inverse() * miss;
            if (!by.allFinite()) return;
            at -= std::min(1.0, longest / by.norm()) * by;
        }
    }
    void add(const Vec2d& at, std::size_t point, const LandedRay& ray,
             const Eigen::Matrix2d& change) {
        if (at.minCoeff() < 0 || at.maxCoeff() > 1) return;
        const double size = change.squaredNorm();
        const double area = std::abs(change.determinant());
        // Landings are right to the tolerance, and places near a fold to its root.
        const double same = 4 * std::sqrt(tolerance / std::sqrt(size));
        for (const Vec2d& other : places[point])
            if ((other - at).norm() < std::min(same, 4 * tolerance * std::sqrt(size) / area + 1e-9))
                return;
        places[point].push_back(at);
        ++light[point].rays;
        light[point].irradiance += ray.power / area;
        light[point].distinctness = std::min(light[point].distinctness, area / size);
    }
};

}  // namespace

std::vector<LightAtPoint> brute_force_light(const std::vector<RayMap>& maps, int side,
                                            const std::vector<Vec2d>& floor) {
    std::vector<LightAtPoint> light(floor.size());
    const Bins bins(floor);
    const auto place = [side](std::size_t i, std::size_t j) -> Vec2d {
        return Vec2d(static_cast<double>(i), static_cast<double>(j)) / side;
    };
    for (const RayMap& map : maps) {
        Found found{std::vector<std::vector<Vec2d>>(floor.size()), light};
        const auto cells = static_cast<std::size_t>(side);
        std::vector<std::optional<LandedRay>> row(cells + 1), before(cells + 1);
        for (std::size_t j = 0; j <= cells; ++j) {
            for (std::size_t i = 0; i <= cells; ++i) row[i] = map(place(i, j));
            for (std::size_t i = 0; j > 0 && i < cells; ++i) {
                Eigen::AlignedBox2d box;
                for (const auto* const corner : {&row[i], &row[i + 1], &before[i], &before[i + 1]})
                    if (*corner) box.extend((*corner)->floor);
                if (box.isEmpty()) continue;
                const Vec2d room = Vec2d::Constant(box.sizes().maxCoeff());
                box.extend(Vec2d(box.max() + room));
                box.extend(Vec2d(box.min() - room));
                bins.each_inside(box, [&](std::size_t point) {
                    found.polish(map, place(i, j) - Vec2d(0, 0.5 / side) + Vec2d(0.5 / side, 0),
                                 point, floor[point], 2.0 / side);
                });
            }
            std::swap(row, before);
        }
    }
    return light;
}

}  // namespace caustics

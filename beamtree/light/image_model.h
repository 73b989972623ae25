#pragma once

#include <array>
#include <optional>

#include "beamtree/beams/beam.h"
#include "beamtree/light/light_chain.h"

namespace caustics::beamtree {

/// A plane through a point, across the light that arrives there.
class ArrivalPlane {
public:
    /// Across the mean of a triangle's rays; empty where they have none.
    static std::optional<ArrivalPlane> at(const Vec3& point,
                                          const std::array<const VertexRay*, 3>& rays);

    const Vec3d& point() const { return point_; }
    double steepness(const Vec3d& way) const { return direction_.dot(way); }
    /// How far a ray goes to the plane [m].
    double way(const Vec3d& position, const Vec3d& direction) const {
        return direction_.dot(point_ - position) / direction_.dot(direction);
    }
    /// Where a ray meets the plane, from the point.
    Vec2d miss(const Vec3d& position, const Vec3d& direction) const {
        return on_plane(position + way(position, direction) * direction - point_);
    }
    /// How that place moves with the start of the ray's chain.
    Eigen::Matrix2d miss_change(const ChainRay& ray) const;

private:
    ArrivalPlane(const Vec3d& point, const Vec3d& direction);
    Vec2d on_plane(const Vec3d& at) const { return {across_[0].dot(at), across_[1].dot(at)}; }

    Vec3d point_;
    Vec3d direction_;
    std::array<Vec3d, 2> across_;
};

/// Where the rays of a polygon miss a point, as a quadratic of two coordinates of the polygon: places are
/// corner 0 + u (corner 1 - corner 0) + v (corner 2 - corner 0).
class ImageModel {
public:
    /// Places of the polygon near which a ray may reach the point.
    struct Solutions {
        std::array<Vec2d, 14> at;
        std::size_t count = 0;

        const Vec2d* begin() const { return at.data(); }
        const Vec2d* end() const { return at.data() + count; }
    };

    /// From the rays of corners and edges' middles; empty where the image cannot hold the point. Rays of a polygon with
    /// a dark part are near the places that they stand for.
    static std::optional<ImageModel> of(const ArrivalPlane& plane,
                                        const std::array<const VertexRay*, 3>& corners,
                                        const EdgeMiddles& middles, bool has_dark_part);
    /// Places all over any polygon.
    static Solutions everywhere();
    /// True if the image folds at or near a place where its change has this determinant.
    bool is_beside_fold(double area) const;
    /// True if the image turns over within the polygon, or nearly.
    bool folds() const;
    /// True if the image is much wider in one part than in another: then the model may lead to no ray though there is one.
    bool is_uneven() const;
    /// One where the image does not turn over; else all that are found from places all over the polygon.
    Solutions solutions() const;
    /// True where the straight-sided image holds the point deeper inside than the image bulges: then a ray reaches it.
    bool surely_holds() const;

private:
    explicit ImageModel(const std::array<Vec2d, 6>& misses);
    bool may_hold(double error) const;
    void find_areas();
    Vec2d straight() const;
    Vec2d solve(Vec2d at) const;
    Vec2d miss(const Vec2d& at) const;
    Eigen::Matrix2d change(const Vec2d& at) const;

    std::array<Vec2d, 6>
        misses_;  ///< of the corners, and of the middles of (0, 1), (1, 2) and (2, 0)
    std::array<Vec2d, 3> bulges_;  ///< of the edges, from the middles of their ends
    double bulge_ = 0;             ///< the largest [m]
    double least_area_ = 0;        ///< of the determinants of change() all over the polygon
    double most_area_ = 0;
    Vec2d u_, v_, uu_, uv_, vv_;  ///< coefficients
};

/// A quick test in float of what ImageModel::of() tests: false where no ray of the polygon can reach the point.
bool may_have_image(const Vec3& point, const std::array<const VertexRay*, 3>& corners,
                    const EdgeMiddles& middles, bool has_dark_part);

/// The least of a place's barycentric coordinates (1 - u - v, u, v), after `beyond` is added to the first.
inline double least_weight(const Vec2d& at, double beyond = 0) {
    return std::min({at.x(), at.y(), 1 - at.x() - at.y() + beyond});
}

}  // namespace caustics::beamtree

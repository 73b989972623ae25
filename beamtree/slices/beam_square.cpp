#include "beamtree/slices/beam_square.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "beamtree/light/find_in_beam.h"

namespace caustics::beamtree {
namespace {

using Triangle = std::array<Vec2d, 3>;

double area_of(const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]) / 2; }

/// A triangle cut by the four sides of a square has up to seven corners.
struct Part {
    std::array<Vec2d, 8> corners;
    std::size_t count = 0;
};

// What lies at sign * axis <= half [Sutherland and Hodgman 1974].
Part cut(const Part& from, Eigen::Index axis, double sign, double half) {
    Part kept;
    for (std::size_t i = 0; i < from.count; ++i) {
        const Vec2d& a = from.corners[i];
        const Vec2d& b = from.corners[(i + 1) % from.count];
        const double beyond_a = sign * a[axis] - half;
        const double beyond_b = sign * b[axis] - half;
        if (beyond_a <= 0) kept.corners[kept.count++] = a;
        if ((beyond_a <= 0) != (beyond_b <= 0))
            kept.corners[kept.count++] = a + beyond_a / (beyond_a - beyond_b) * (b - a);
    }
    return kept;
}

Part on_square(const Triangle& triangle, double half) {
    Part part;
    for (const Vec2d& corner : triangle) part.corners[part.count++] = corner;
    for (const Eigen::Index axis : {0, 1})
        for (const double sign : {-1.0, 1.0}) part = cut(part, axis, sign, half);
    return part;
}

/// Area, with the sign of the triangle's, centre and covariance of its places.
struct Extent {
    double area = 0;
    Vec2d middle = Vec2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

Extent extent(const Part& part) {
    Extent found;
    if (part.count == 0) return found;
    const Vec2d& first = part.corners[0];
    for (std::size_t i = 1; i + 1 < part.count; ++i) {
        const Vec2d u = part.corners[i] - first;
        const Vec2d v = part.corners[i + 1] - first;
        const Vec2d sum = u + v;
        const double area = cross(u, v) / 2;
        found.area += area;
        found.middle += area / 3 * sum;
        found.covariance +=
            area / 12 * (u * u.transpose() + v * v.transpose() + sum * sum.transpose());
    }
    found.middle /= found.area;
    found.covariance /= found.area;
    found.covariance -= found.middle * found.middle.transpose();
    found.middle += first;
    return found;
}

// The triangle round the plane's point, in the frame's coordinates. Empty where its light does not
// come down to the plane everywhere, or not evenly.
std::optional<Triangle> project(const std::array<const VertexRay*, 3>& rays, const TestPlane& plane,
                                const SliceFrame& frame) {
    const Vec2d origin = frame.across(plane.point());
    Triangle at;
    double least = 1;
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double height = plane.height(rays[i]->position);
        const double steepness = plane.steepness(rays[i]->direction);
        if (!(height > 0 && steepness > 0)) return {};
        least = std::min(least, steepness);
        most = std::max(most, steepness);
        at[i] = frame.across(rays[i]->position.cast<double>() +
                             height / steepness * rays[i]->direction.cast<double>()) -
                origin;
    }
    if (most > most_uneven * least) return {};
    return at;
}

// Of the weights of corners 1 and 2, 2 and 0, 0 and 1.
Vec3 weights_covariances(const Eigen::Matrix2d& of_places, const Triangle& t, double area) {
    std::array<Vec2d, 3> slope;  // of the weights
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d side = t[(i + 2) % 3] - t[(i + 1) % 3];
        slope[i] = Vec2d(-side.y(), side.x()) / (2 * area);
    }
    Vec3 found;
    for (std::size_t i = 0; i < 3; ++i)
        found[static_cast<Eigen::Index>(i)] =
            static_cast<float>(slope[(i + 1) % 3].dot(of_places * slope[(i + 2) % 3]));
    return found;
}

Vec3 weights_at(const Vec2d& p, const Triangle& t, double area) {
    const Vec3d weights(cross(t[1] - p, t[2] - p), cross(t[2] - p, t[0] - p),
                        cross(t[0] - p, t[1] - p));
    return (weights / (2 * area)).cast<float>();
}

}  // namespace

void find_on_square(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                    const BeamNumber& number, const TestPlane& plane, const BeamSquare& square,
                    std::vector<BeamHit>& hits, SearchCounts& counts) {
    const std::size_t count = rays[3] == nullptr ? 1 : 2;
    std::array<Triangle, 2> triangles;
    std::array<double, 2> areas{};
    for (std::size_t i = 0; i < count; ++i) {
        const auto projected = project({rays[0], rays[1 + i], rays[2 + i]}, plane, square.frame);
        if (!projected) return find_in_beam(set, rays, number, plane, hits, counts);
        triangles[i] = *projected;
        areas[i] = area_of(*projected);
    }
    // Two triangles that keep their orientation are one caustic polygon.
    const bool together = areas[0] * areas[1] > 0;
    ++counts.beam_point_tests;
    const std::size_t before = hits.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (areas[i] == 0) continue;
        const Extent part = extent(on_square(triangles[i], square.half));
        if (!(part.area / areas[i] > 0)) continue;
        BeamHit hit;
        hit.set = number.set;
        hit.beam = number.beam;
        hit.triangle = static_cast<std::uint8_t>(i);
        hit.winding = areas[i] > 0 ? 1 : -1;
        hit.plane_normal = plane.normal().cast<float>();
        hit.weights = weights_at(part.middle, triangles[i], areas[i]);
        hit.covariances = weights_covariances(part.covariance, triangles[i], areas[i]);
        hit.area = std::abs(together ? areas[0] + areas[1] : areas[i]);
        hit.coverage = std::abs(part.area) / (4 * square.half * square.half);
        if (count == 2 && !together) hit.flux_share = set.beams[number.beam].share_of(i);
        hits.push_back(hit);
    }
    counts.beam_point_hits += hits.size() > before ? 1 : 0;
}

}  // namespace caustics::beamtree

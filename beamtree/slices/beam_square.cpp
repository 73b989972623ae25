#include "beamtree/slices/beam_square.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "beamtree/cones/plane_groups.h"
#include "beamtree/light/find_in_beam.h"

namespace caustics::beamtree {
namespace {

using Triangle = std::array<Vec2d, 3>;

double area_of(const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]) / 2; }

/// A triangle cut by the four sides of a square has up to seven corners; rounding may add some.
struct Part {
    std::array<Vec2d, 16> corners;
    std::size_t count = 0;
};

// What lies within one side [Sutherland and Hodgman 1974].
Part cut(const Part& from, const Vec2d& outward, double limit) {
    Part kept;
    for (std::size_t i = 0; i < from.count; ++i) {
        const Vec2d& a = from.corners[i];
        const Vec2d& b = from.corners[(i + 1) % from.count];
        const double beyond_a = outward.dot(a) - limit;
        const double beyond_b = outward.dot(b) - limit;
        if (beyond_a <= 0) kept.corners[kept.count++] = a;
        if ((beyond_a <= 0) != (beyond_b <= 0))
            kept.corners[kept.count++] = a + beyond_a / (beyond_a - beyond_b) * (b - a);
    }
    return kept;
}

Part within(const BeamSquare& square, const Triangle& triangle) {
    Part part;
    for (const Vec2d& corner : triangle) part.corners[part.count++] = corner;
    for (std::size_t i = 0; i < 4; ++i) part = cut(part, square.outward[i], square.limit[i]);
    return part;
}

// Whether one of the square's sides, or of the triangle's, has the other figure on its outer side.
bool apart(const BeamSquare& square, const Triangle& triangle, double area) {
    for (std::size_t i = 0; i < 4; ++i)
        if (std::ranges::all_of(triangle, [&](const Vec2d& p) {
                return square.outward[i].dot(p) - square.limit[i] > 0;
            }))
            return true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d side = triangle[(i + 1) % 3] - triangle[i];
        if (std::ranges::all_of(square.cell->corners, [&](const Vec2d& p) {
                return cross(side, p - triangle[i]) * area < 0;
            }))
            return true;
    }
    return false;
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

double area_on_film(const Part& part, const PixelCell& cell) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < part.count; ++i) {
        const Vec2d first = cell.on_film(part.corners[0]);
        area += cross(cell.on_film(part.corners[i]) - first,
                      cell.on_film(part.corners[i + 1]) - first) /
                2;
    }
    return area;
}

/// One of a beam's triangles on the tree's plane through the point, where boxes bound it and its light comes down evenly.
/// Coordinates are from the point.
struct OnPlane {
    Triangle at;
    double area = 0;  ///< with the sign of the triangle's turn
    Vec3d direction;  ///< that its light has at the point, or at the nearest of its places
};

Vec3d weights_at(const Vec2d& p, const Triangle& t, double area) {
    const Vec3d weights(cross(t[1] - p, t[2] - p), cross(t[2] - p, t[0] - p),
                        cross(t[0] - p, t[1] - p));
    return weights / (2 * area);
}

// Empty where it does not come down to the plane everywhere, or not evenly.
std::optional<OnPlane> project(const std::array<const VertexRay*, 3>& rays,
                               const TestPlane& plane) {
    OnPlane found;
    double least = 1;
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double height = plane.height(rays[i]->position);
        const double steepness = plane.steepness(rays[i]->direction);
        if (!(height > 0 && steepness > 0)) return {};
        least = std::min(least, steepness);
        most = std::max(most, steepness);
        found.at[i] = plane.project(rays[i]->position, height / steepness, rays[i]->direction);
    }
    if (most > most_uneven * least) return {};
    found.area = area_of(found.at);
    found.direction = Vec3d::Zero();
    if (found.area == 0) return found;
    const Vec3d nearest = weights_at(Vec2d::Zero(), found.at, found.area).cwiseMax(0);
    for (std::size_t i = 0; i < 3; ++i)
        found.direction +=
            nearest[static_cast<Eigen::Index>(i)] * rays[i]->direction.cast<double>();
    return found;
}

// From the cell's coordinates to those on the tree's plane, along the light. Empty where the light does not come to the cell's
// front.
std::optional<Eigen::Matrix2d> along_light(const PixelCell& cell, const TestPlane& plane,
                                           const Vec3d& direction) {
    if (!(cell.normal.dot(direction) < 0)) return {};
    const auto onto = [&](const Vec3d& way) {
        return plane.across(way -
                            plane.normal().dot(way) / plane.normal().dot(direction) * direction);
    };
    Eigen::Matrix2d map;
    map << onto(cell.axes.right), onto(cell.axes.forward);
    if (map.determinant() == 0) return {};
    return map;
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

}  // namespace

std::optional<BeamSquare> BeamSquare::at(const Vec3& point, const PixelCell& cell) {
    BeamSquare square{.plane = TestPlane(point, cell.normal.cast<float>()), .cell = &cell};
    const double turn = cross(cell.corners[2] - cell.corners[0], cell.corners[3] - cell.corners[1]);
    if (turn == 0) return {};
    Part all;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d side = cell.corners[(i + 1) % 4] - cell.corners[i];
        square.outward[i] = (turn > 0 ? 1 : -1) * Vec2d(side.y(), -side.x());
        square.limit[i] = square.outward[i].dot(cell.corners[i]);
        all.corners[all.count++] = cell.corners[i];
    }
    square.area = area_on_film(all, cell);
    return square;
}

CellReach reach_of(const PixelCell& cell, const SliceFrame& frame) {
    constexpr auto sine = static_cast<double>(least_sine);
    const double most_slant = std::sqrt(1 / (sine * sine) - 1);
    CellReach reach;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d corner = cell.corner(i);
        const double slanted = most_slant * std::abs(frame.rise(corner));
        reach.across =
            reach.across.cwiseMax(frame.along(corner).cwiseAbs() + Vec2d::Constant(slanted));
        reach.down = std::max(reach.down, -frame.rise(corner));
    }
    return reach;
}

void find_on_square(const BeamSet& set, const std::array<const VertexRay*, 4>& rays,
                    const BeamNumber& number, const TestPlane& trees_plane,
                    const BeamSquare& square, std::vector<BeamHit>& hits, SearchCounts& counts) {
    const std::size_t count = rays[3] == nullptr ? 1 : 2;
    std::array<OnPlane, 2> triangles;
    const auto project_all = [&](const TestPlane& onto) {
        for (std::size_t i = 0; i < count; ++i) {
            const auto projected = project({rays[0], rays[1 + i], rays[2 + i]}, onto);
            if (!projected) return false;
            triangles[i] = *projected;
        }
        return true;
    };
    // Of a large square, light of which some begins beyond the trees' plane comes down to the receiver's.
    const bool on_trees_plane = project_all(trees_plane);
    if (!on_trees_plane && !project_all(square.plane))
        return find_in_beam(set, rays, number, trees_plane, hits, counts);
    const TestPlane& plane = on_trees_plane ? trees_plane : square.plane;
    // Two triangles that keep their orientation are one caustic polygon.
    const bool together = triangles[0].area * triangles[1].area > 0;
    ++counts.beam_point_tests;
    const std::size_t before = hits.size();
    for (std::size_t i = 0; i < count; ++i) {
        const OnPlane& whole = triangles[i];
        const auto map = along_light(*square.cell, plane, whole.direction);
        if (whole.area == 0 || !map) continue;
        const Eigen::Matrix2d back = map->inverse();
        const Triangle triangle = {back * whole.at[0], back * whole.at[1], back * whole.at[2]};
        const double area = area_of(triangle);
        if (apart(square, triangle, area)) continue;
        const Part covered = within(square, triangle);
        const Extent part = extent(covered);
        if (!(part.area / area > 0)) continue;
        BeamHit hit;
        hit.set = number.set;
        hit.beam = number.beam;
        hit.triangle = static_cast<std::uint8_t>(i);
        hit.winding = whole.area > 0 ? 1 : -1;
        hit.plane_normal = plane.normal().cast<float>();
        hit.weights = weights_at(part.middle, triangle, area).cast<float>();
        hit.covariances = weights_covariances(part.covariance, triangle, area);
        hit.area = std::abs(together ? triangles[0].area + triangles[1].area : whole.area) *
                   plane.area_scale();
        hit.coverage = std::abs(area_on_film(covered, *square.cell) / square.area);
        hit.offset = square.cell->at(part.middle).cast<float>();
        hit.cell_radius = static_cast<float>(square.cell->radius);
        if (count == 2 && !together) hit.flux_share = set.beams[number.beam].share_of(i);
        hits.push_back(hit);
    }
    counts.beam_point_hits += hits.size() > before ? 1 : 0;
}

}  // namespace caustics::beamtree

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

/// A triangle cut by the four sides of a square has up to seven corners.
struct Part {
    std::array<Vec2d, 8> corners;
    std::size_t count = 0;
};

/// A convex quadrilateral: what lies at outward . p <= limit for each side.
struct Window {
    std::array<Vec2d, 4> outward;
    std::array<double, 4> limit;
};

Window square_window(double half) {
    return {{Vec2d(-1, 0), Vec2d(1, 0), Vec2d(0, -1), Vec2d(0, 1)}, {half, half, half, half}};
}

// Empty where it has no area.
std::optional<Window> window_of(const std::array<Vec2d, 4>& corners) {
    Window window;
    const double area = cross(corners[2] - corners[0], corners[3] - corners[1]);
    if (area == 0) return {};
    const double turn = area > 0 ? 1 : -1;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d side = corners[(i + 1) % 4] - corners[i];
        window.outward[i] = turn * Vec2d(side.y(), -side.x());
        window.limit[i] = window.outward[i].dot(corners[i]);
    }
    return window;
}

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

Part within(const Window& window, const Triangle& triangle) {
    Part part;
    for (const Vec2d& corner : triangle) part.corners[part.count++] = corner;
    for (std::size_t i = 0; i < 4; ++i) part = cut(part, window.outward[i], window.limit[i]);
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

Part all_of(const PixelCell& cell) {
    Part part;
    for (const Vec2d& corner : cell.corners) part.corners[part.count++] = corner;
    return part;
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

/// A plane with coordinates from its point, and the window on it.
struct Asked {
    TestPlane plane;
    const SliceFrame* frame;  ///< whose axes are the coordinates', or:
    const PixelCell* cell;
    Window window;
    double area;  ///< of the window; of a cell as the camera shows it

    // Empty for a cell that has no area.
    static std::optional<Asked> about(const BeamSquare& square, const TestPlane& plane) {
        if (square.cell == nullptr)
            return Asked{plane, &square.frame, nullptr, square_window(square.half),
                         4 * square.half * square.half};
        const auto window = window_of(square.cell->corners);
        if (!window) return {};
        return Asked{TestPlane(plane.point().cast<float>(), square.cell->normal.cast<float>()),
                     nullptr, square.cell, *window,
                     area_on_film(all_of(*square.cell), *square.cell)};
    }
    double area_of(const Part& part, const Extent& extent) const {
        return cell == nullptr ? extent.area : area_on_film(part, *cell);
    }
    Vec2d place(const Vec3d& p) const {
        return cell == nullptr ? frame->across(p) - frame->across(plane.point())
                               : cell->along(p - plane.point());
    }
};

// The triangle on the plane that is asked about. Empty where its light does not come down to the plane
// everywhere, or not evenly.
std::optional<Triangle> project(const std::array<const VertexRay*, 3>& rays, const Asked& asked) {
    Triangle at;
    double least = 1;
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double height = asked.plane.height(rays[i]->position);
        const double steepness = asked.plane.steepness(rays[i]->direction);
        if (!(height > 0 && steepness > 0)) return {};
        least = std::min(least, steepness);
        most = std::max(most, steepness);
        at[i] = asked.place(rays[i]->position.cast<double>() +
                            height / steepness * rays[i]->direction.cast<double>());
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
                    const BeamNumber& number, const TestPlane& plane, const BeamSquare& square,
                    std::vector<BeamHit>& hits, SearchCounts& counts) {
    const std::size_t count = rays[3] == nullptr ? 1 : 2;
    const auto asked = Asked::about(square, plane);
    std::array<Triangle, 2> triangles;
    std::array<double, 2> areas{};
    for (std::size_t i = 0; i < count; ++i) {
        const auto projected =
            asked ? project({rays[0], rays[1 + i], rays[2 + i]}, *asked) : std::nullopt;
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
        const Part covered = within(asked->window, triangles[i]);
        const Extent part = extent(covered);
        if (!(part.area / areas[i] > 0)) continue;
        BeamHit hit;
        hit.set = number.set;
        hit.beam = number.beam;
        hit.triangle = static_cast<std::uint8_t>(i);
        hit.winding = areas[i] > 0 ? 1 : -1;
        hit.plane_normal = asked->plane.normal().cast<float>();
        hit.weights = weights_at(part.middle, triangles[i], areas[i]);
        hit.covariances = weights_covariances(part.covariance, triangles[i], areas[i]);
        hit.area = std::abs(together ? areas[0] + areas[1] : areas[i]);
        hit.coverage = std::abs(asked->area_of(covered, part)) / std::abs(asked->area);
        if (square.cell != nullptr) {
            hit.offset = square.cell->at(part.middle).cast<float>();
            hit.cell_radius = static_cast<float>(square.cell->radius);
        }
        if (count == 2 && !together) hit.flux_share = set.beams[number.beam].share_of(i);
        hits.push_back(hit);
    }
    counts.beam_point_hits += hits.size() > before ? 1 : 0;
}

}  // namespace caustics::beamtree

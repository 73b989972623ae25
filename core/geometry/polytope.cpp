#include "core/geometry/polytope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"

namespace caustics {
namespace {

constexpr double least_determinant = 1e-9;
// Of the solid's size: still distinct as floats.
constexpr double merging = 1e-6;
// What bounds are looked for in, in distances of the farthest plane.
constexpr double room = 1e4;

double farthest(const std::vector<HalfSpace>& planes) {
    double most = 0;
    for (const HalfSpace& plane : planes) most = std::max(most, std::abs(plane.distance));
    return most > 0 ? most : 1;
}

std::vector<HalfSpace> walls(double distance) {
    std::vector<HalfSpace> box;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) box.push_back({side * Vec3d::Unit(axis), distance});
    return box;
}

bool is_inside(const std::vector<HalfSpace>& planes, const Vec3d& point, double slack) {
    return std::ranges::all_of(planes, [&](const HalfSpace& plane) {
        return plane.normal.dot(point) <= plane.distance + slack;
    });
}

// The corners of all triples of planes that lie in all half-spaces; a corner of more than three
// planes comes several times, in roundings of its own.
std::vector<Vec3d> corners(const std::vector<HalfSpace>& planes, double slack) {
    std::vector<Vec3d> found;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            const Vec3d edge = planes[i].normal.cross(planes[j].normal);
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                const double determinant = edge.dot(planes[k].normal);
                if (std::abs(determinant) < least_determinant) continue;
                const Vec3d point = (planes[i].distance * planes[j].normal.cross(planes[k].normal) +
                                     planes[j].distance * planes[k].normal.cross(planes[i].normal) +
                                     planes[k].distance * edge) /
                                    determinant;
                if (is_inside(planes, point, slack)) found.push_back(point);
            }
        }
    return found;
}

double extent(const std::vector<Vec3d>& points) {
    Eigen::AlignedBox3d box;
    for (const Vec3d& p : points) box.extend(p);
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

void check_bounds(const std::vector<HalfSpace>& planes, double scale) {
    std::vector<HalfSpace> in_room = planes;
    for (const HalfSpace& wall : walls(room * scale)) in_room.push_back(wall);
    for (const Vec3d& corner : corners(in_room, 1e-10 * room * scale)) {
        if (corner.lpNorm<Eigen::Infinity>() < 0.99 * room * scale) continue;
        const Vec3d way = corner / corner.lpNorm<Eigen::Infinity>();
        throw InputError(
            fmt::format("the planes leave the solid open towards [{:.3g}, {:.3g}, "
                        "{:.3g}]",
                        way.x(), way.y(), way.z()));
    }
}

std::vector<Vec3d> merged(const std::vector<Vec3d>& points, double tolerance) {
    std::vector<Vec3d> apart;
    for (const Vec3d& p : points)
        if (std::ranges::none_of(apart, [&](const Vec3d& q) { return (p - q).norm() < tolerance; }))
            apart.push_back(p);
    return apart;
}

// The vertices on a plane, in their order round their middle.
std::vector<std::uint32_t> facet(const std::vector<Vec3d>& vertices, const HalfSpace& plane,
                                 double tolerance) {
    std::vector<std::uint32_t> on_it;
    Vec3d middle = Vec3d::Zero();
    for (std::uint32_t i = 0; i < vertices.size(); ++i)
        if (std::abs(plane.normal.dot(vertices[i]) - plane.distance) < tolerance) {
            on_it.push_back(i);
            middle += vertices[i];
        }
    if (on_it.size() < 3) return {};
    middle /= static_cast<double>(on_it.size());
    const Vec3d u = plane.normal.unitOrthogonal();
    const Vec3d v = plane.normal.cross(u);
    const auto angle = [&](std::uint32_t i) {
        const Vec3d p = vertices[i] - middle;
        return std::atan2(p.dot(v), p.dot(u));
    };
    std::ranges::sort(on_it, {}, angle);
    return on_it;
}

// Each edge in both directions, once each.
bool is_closed(const Polytope& solid) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& corners_of : solid.facets)
        for (std::size_t i = 0; i < corners_of.size(); ++i)
            ++edges[{corners_of[i], corners_of[(i + 1) % corners_of.size()]}];
    return std::ranges::all_of(edges, [&](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return edge.second == 1 && back != edges.end() && back->second == 1;
    });
}

}  // namespace

Polytope intersect(const std::vector<HalfSpace>& planes) {
    const double scale = farthest(planes);
    check_bounds(planes, scale);
    const std::vector<Vec3d> all = corners(planes, 1e-9 * scale);
    const double size = extent(all);
    Polytope solid;
    solid.vertices = merged(all, merging * size);
    std::size_t facets = 0;
    for (const HalfSpace& plane : planes) {
        std::vector<std::uint32_t> found = facet(solid.vertices, plane, merging * size);
        // The same plane once more.
        const bool again = std::ranges::find(solid.facets, found) != solid.facets.end();
        if (again) found.clear();
        facets += found.empty() ? 0 : 1;
        solid.facets.push_back(std::move(found));
    }
    if (solid.vertices.size() < 4 || facets < 4) throw InputError("the planes enclose nothing");
    if (!is_closed(solid)) throw InputError("some planes meet too closely to be distinct");
    return solid;
}

}  // namespace caustics

#include "beamtree/light/beam_point.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "beamtree/light/projected.h"

namespace caustics::beamtree {
namespace {

/// What cuts a clipped triangle: nothing (its own corner), the plane, or rays that run along it.
enum class Limit { none, height, steepness };

/// A corner of a clipped triangle: where it is on the plane, and which point of the triangle.
struct ClippedCorner {
    Vec2d at = Vec2d::Zero();
    Vec3d weights = Vec3d::Zero();
    Limit limit = Limit::none;
};

/// Up to six ends of clipped edges, and the corner where the two limits meet.
struct ClippedPolygon {
    std::array<ClippedCorner, 7> corners;
    std::size_t count = 0;

    void add(const ClippedCorner& corner) { corners[count++] = corner; }
};

// Neighbours clip a shared edge from the same end, so that both find the same bits.
bool comes_first(const VertexRay& a, const VertexRay& b) {
    const auto key = [](const VertexRay& r) {
        return std::tuple(r.position.x(), r.position.y(), r.position.z(), r.direction.x(),
                          r.direction.y(), r.direction.z());
    };
    return key(a) < key(b);
}

/// One end of what is left of an edge: its place along the edge and what cut it there.
struct EdgeEnd {
    double t;
    Limit limit;
};

ClippedCorner corner_at(const TestPlane& plane, const RayOnPlane& a, const RayOnPlane& b,
                        const EdgeEnd& edge_end, std::size_t index_a, std::size_t index_b) {
    const double t = edge_end.t;
    ClippedCorner corner;
    corner.limit = edge_end.limit;
    corner.weights[static_cast<Eigen::Index>(index_a)] = 1 - t;
    corner.weights[static_cast<Eigen::Index>(index_b)] = t;
    const RayOnPlane& end = t == 0 ? a : b;
    if ((t == 0 || t == 1) && end.comes_down()) {
        corner.at = end.at;
        return corner;
    }
    const double height = std::max(0.0, (1 - t) * a.height + t * b.height);
    const double steepness = std::max(least_steepness, (1 - t) * a.steepness + t * b.steepness);
    const double s = height / steepness;
    corner.at = (1 - t) * plane.project(a.ray->position, s, a.ray->direction) +
                t * plane.project(b.ray->position, s, b.ray->direction);
    return corner;
}

// Where the rays of the triangle's inside are both at the plane and along it. Empty when the two
// limits do not cross.
std::optional<ClippedCorner> corner_of_limits(const TestPlane& plane,
                                              const std::array<RayOnPlane, 3>& rays) {
    Vec3d height;
    Vec3d steepness;
    for (std::size_t i = 0; i < 3; ++i) {
        height[static_cast<Eigen::Index>(i)] = rays[i].height;
        steepness[static_cast<Eigen::Index>(i)] = rays[i].steepness - least_steepness;
    }
    const Vec3d weights = height.cross(steepness);
    const double sum = weights.sum();
    if (sum == 0) return {};
    ClippedCorner corner;
    corner.weights = (weights / sum).cwiseMax(0);
    corner.weights /= corner.weights.sum();
    for (std::size_t i = 0; i < 3; ++i)
        corner.at += corner.weights[static_cast<Eigen::Index>(i)] *
                     plane.project(rays[i].ray->position, 0, rays[i].ray->direction);
    return corner;
}

// The part of an edge whose rays come down to the plane, appended in the edge's own direction.
void clip_edge(const TestPlane& plane, const std::array<RayOnPlane, 3>& rays, std::size_t from,
               std::size_t to, ClippedPolygon& polygon) {
    const bool forward = comes_first(*rays[from].ray, *rays[to].ray);
    const std::size_t first = forward ? from : to;
    const std::size_t last = forward ? to : from;
    EdgeEnd begin{0, Limit::none};
    EdgeEnd end{1, Limit::none};
    const auto keep_positive = [&](double a, double b, Limit limit) {
        if (a <= 0 && b <= 0) end.t = -1;
        if (a <= 0 && b > 0 && a / (a - b) >= begin.t) begin = {a / (a - b), limit};
        if (a > 0 && b <= 0 && a / (a - b) <= end.t) end = {a / (a - b), limit};
    };
    keep_positive(rays[first].height, rays[last].height, Limit::height);
    keep_positive(rays[first].steepness - least_steepness, rays[last].steepness - least_steepness,
                  Limit::steepness);
    if (!(begin.t < end.t)) return;
    if (!forward) std::swap(begin, end);
    polygon.add(corner_at(plane, rays[first], rays[last], begin, first, last));
    polygon.add(corner_at(plane, rays[first], rays[last], end, first, last));
}

// Goes round the triangle's edges. Where one limit cuts the way out and the other the way back in,
// what is left has a corner where they meet; it is the triangle's own, no neighbour shares it.
ClippedPolygon clipped(const TestPlane& plane, const std::array<RayOnPlane, 3>& rays) {
    ClippedPolygon ends;
    for (std::size_t i = 0; i < 3; ++i) clip_edge(plane, rays, i, (i + 1) % 3, ends);
    ClippedPolygon polygon;
    for (std::size_t i = 0; i < ends.count; ++i) {
        const ClippedCorner& out = ends.corners[i];
        const ClippedCorner& in = ends.corners[(i + 1) % ends.count];
        polygon.add(out);
        // Ends of an edge come in pairs; the way out is the second of a pair.
        if (i % 2 == 0 || out.limit == Limit::none || in.limit == Limit::none ||
            out.limit == in.limit)
            continue;
        if (const auto corner = corner_of_limits(plane, rays)) polygon.add(*corner);
    }
    return polygon;
}

// Which point of the triangle the origin is: barycentric in the fan's triangle that holds it, or
// comes nearest to it.
Vec3d weights_at_origin(const ClippedPolygon& polygon) {
    const auto& corners = polygon.corners;
    Vec3d best = Vec3d::Zero();
    double best_least = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
        const Vec2d& a = corners[0].at;
        const Vec2d& b = corners[i].at;
        const Vec2d& c = corners[i + 1].at;
        const double area = cross(b - a, c - a);
        if (area == 0) continue;
        const Vec3d l = Vec3d(cross(b, c), cross(c, a), cross(a, b)) / area;
        if (l.minCoeff() <= best_least) continue;
        best_least = l.minCoeff();
        best =
            l[0] * corners[0].weights + l[1] * corners[i].weights + l[2] * corners[i + 1].weights;
    }
    best = best.cwiseMax(0);
    return best.sum() > 0 ? Vec3d(best / best.sum()) : Vec3d::Constant(1.0 / 3);
}

Projected project_polygon(const ClippedPolygon& polygon) {
    Projected found;
    double kept = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const ClippedCorner& a = polygon.corners[i];
        const ClippedCorner& b = polygon.corners[(i + 1) % polygon.count];
        found.winding += edge_crossing(a.at, b.at);
        found.area += cross(a.at, b.at) / 2;
        // Twice the share of the triangle's area, in the coordinates (l1, l2).
        kept += a.weights[1] * b.weights[2] - a.weights[2] * b.weights[1];
    }
    found.share = std::abs(kept);
    return found;
}

// Seldom needed: kept out of the way of the common case.
[[gnu::noinline]] Projected project_clipped(const TestPlane& plane,
                                            const std::array<RayOnPlane, 3>& rays) {
    const ClippedPolygon polygon = clipped(plane, rays);
    Projected found = project_polygon(polygon);
    if (found.winding != 0) found.weights = weights_at_origin(polygon);
    return found;
}

using Corners = std::array<const VertexRay*, 3>;

inline std::array<RayOnPlane, 3> on_plane(const Corners& corners, const TestPlane& plane) {
    return {on_plane(*corners[0], plane), on_plane(*corners[1], plane),
            on_plane(*corners[2], plane)};
}

// Whether the light goes down to the plane much more steeply on one side of the triangle than on
// another, or there along the plane or away from it.
bool is_uneven(const std::array<RayOnPlane, 3>& rays) {
    const double least =
        std::min(std::min(rays[0].steepness, rays[1].steepness), rays[2].steepness);
    const double most = std::max(std::max(rays[0].steepness, rays[1].steepness), rays[2].steepness);
    return !(most <= most_uneven * least);
}

// A caustic polygon that runs towards the horizon is not lit evenly: its area says nothing of the
// density where the point is. On the plane across the light that arrives at the point it is; from
// there come area, share and weights. The area is the one on the test's plane with that density.
[[gnu::noinline]] void measure_across(const Corners& corners, const TestPlane& plane,
                                      Projected& found) {
    for (int round = 0; round < 2; ++round) {
        Vec3 light = Vec3::Zero();
        for (std::size_t i = 0; i < 3; ++i)
            light += static_cast<float>(found.weights[static_cast<Eigen::Index>(i)]) *
                     corners[i]->direction;
        if (light.isZero(0)) return;
        light.normalize();
        const TestPlane across(plane.point().cast<float>(), -light);
        const ClippedPolygon polygon = clipped(across, on_plane(corners, across));
        const Projected even = project_polygon(polygon);
        if (even.area == 0) return;
        const double steepness = std::max(least_steepness, plane.steepness(light));
        found.area = std::copysign(
            even.area * across.area_scale() / (steepness * plane.area_scale()), found.area);
        found.share = even.share;
        found.weights = weights_at_origin(polygon);
    }
}

void write_hit(const Projected& found, std::size_t triangle, const TestPlane& plane, BeamHit& hit) {
    hit.plane_normal = plane.normal().cast<float>();
    hit.triangle = static_cast<std::uint8_t>(triangle);
    hit.winding = static_cast<std::int8_t>(found.winding > 0 ? 1 : -1);
    hit.weights = found.weights.cast<float>();
    hit.area = std::abs(found.area) * plane.area_scale();
    hit.flux_share = found.share;
}

// Of a triangle; less is cut off by the rounding of a corner that lies on the plane.
constexpr double least_cut = 1e-6;

/// What became of a triangle's test.
struct Tested {
    Projected found;
    bool apart;  ///< cut, or not lit evenly

    bool is_hit() const { return found.is_hit(); }
};

inline Tested test_triangle(const Corners& corners, const TestPlane& plane) {
    const std::array<RayOnPlane, 3> rays = on_plane(corners, plane);
    const bool whole = rays[0].comes_down() && rays[1].comes_down() && rays[2].comes_down();
    const bool uneven = is_uneven(rays);
    Tested tested{
        whole ? projected(rays[0].at, rays[1].at, rays[2].at) : project_clipped(plane, rays),
        uneven};
    tested.apart = uneven || tested.found.share < 1 - least_cut;
    if (uneven && tested.found.winding != 0) measure_across(corners, plane, tested.found);
    return tested;
}

// Four corners that keep their orientation and are lit evenly are one caustic polygon; otherwise each
// triangle keeps its own flux.
int test_quad(const std::array<const VertexRay*, 4>& rays, const Beam& beam, const TestPlane& plane,
              std::vector<BeamHit>& hits) {
    const std::array<Tested, 2> parts = {test_triangle(Corners{rays[0], rays[1], rays[2]}, plane),
                                         test_triangle(Corners{rays[0], rays[2], rays[3]}, plane)};
    const bool together =
        !parts[0].apart && !parts[1].apart && parts[0].found.area * parts[1].found.area > 0;
    int written = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        if (!parts[i].is_hit()) continue;
        BeamHit& hit = hits.emplace_back();
        write_hit(parts[i].found, i, plane, hit);
        if (together)
            hit.area = std::abs(parts[0].found.area + parts[1].found.area) * plane.area_scale();
        else
            hit.flux_share *= beam.share_of(i);
        ++written;
    }
    return written;
}

}  // namespace

int test_beam(const std::array<const VertexRay*, 4>& rays, const Beam& beam, const TestPlane& plane,
              std::vector<BeamHit>& hits) {
    if (rays[3] != nullptr) return test_quad(rays, beam, plane, hits);
    return test_triangle(Corners{rays[0], rays[1], rays[2]}, 0, plane, hits) ? 1 : 0;
}

bool test_triangle(const std::array<const VertexRay*, 3>& rays, std::size_t number,
                   const TestPlane& plane, std::vector<BeamHit>& hits) {
    const Tested tested = test_triangle(rays, plane);
    if (tested.is_hit()) write_hit(tested.found, number, plane, hits.emplace_back());
    return tested.is_hit();
}

int test_beam(const BeamSet& set, const Beam& beam, const TestPlane& plane,
              std::array<BeamHit, 2>& hits) {
    std::array<const VertexRay*, 4> rays = {};
    for (std::size_t i = 0; i < 4; ++i)
        if (beam.corners[i] != Beam::none) rays[i] = &set.rays[beam.corners[i]];
    std::vector<BeamHit> found;
    const int count = test_beam(rays, beam, plane, found);
    std::ranges::copy(found, hits.begin());
    return count;
}

std::optional<BeamHit> test_triangle(const std::array<VertexRay, 3>& corners, std::size_t number,
                                     const TestPlane& plane) {
    const Tested tested = test_triangle(Corners{&corners[0], &corners[1], &corners[2]}, plane);
    if (!tested.is_hit()) return {};
    std::optional<BeamHit> hit(std::in_place);
    write_hit(tested.found, number, plane, *hit);
    return hit;
}

}  // namespace caustics::beamtree

#include <algorithm>
#include <cmath>

#include "beamtree/cones/cone.h"
#include "beamtree/cones/neck.h"

namespace caustics::beamtree {
namespace {

/// Rays as lines over the axial distance t: across(t) = start + t slope.
struct AxialLine {
    Vec2d start;
    Vec2d slope;
    double begins;  ///< axial distance of the vertex

    Vec2d at(double t) const { return start + t * slope; }
};

std::vector<AxialLine> axial_lines(const NodeRays& rays, const Vec3d& origin, const Vec3d& a,
                                   const Vec3d& s, const Vec3d& t) {
    std::vector<AxialLine> lines;
    for (std::size_t i = 0; i < rays.positions.size(); ++i) {
        const Vec3d p = rays.positions[i] - origin;
        const Vec3d& d = rays.directions[i];
        const double along = d.dot(a);
        const double begins = p.dot(a);
        const Vec2d slope = Vec2d(d.dot(s), d.dot(t)) / along;
        lines.push_back({Vec2d(p.dot(s), p.dot(t)) - begins * slope, slope, begins});
    }
    return lines;
}

}  // namespace

DoubleCone double_cone(const NodeRays& rays, const Cap& cap, double reach) {
    DoubleCone cone;
    if (cap.cosine < 0.5) return cone;
    const Vec3d a = cap.axis;
    const Vec3d s = a.unitOrthogonal();
    const Vec3d t = a.cross(s);
    const Vec3d origin = rays.positions.front();
    const std::vector<AxialLine> lines = axial_lines(rays, origin, a, s, t);
    double first = lines.front().begins;
    double last = first;
    double tangent = 0;
    for (const AxialLine& line : lines) {
        first = std::min(first, line.begins);
        last = std::max(last, line.begins);
        tangent = std::max(tangent, line.slope.norm());
    }
    std::vector<Vec2d> points(lines.size());
    const auto circle_at = [&](double depth) {
        for (std::size_t i = 0; i < lines.size(); ++i) points[i] = lines[i].at(depth);
        return smallest_circle(points);
    };
    const double neck =
        find_neck([&](double depth) { return circle_at(depth).radius; }, first, last + reach);
    const Circle circle = circle_at(neck);
    double width = 0;
    double spreading = 0;
    for (const auto& triangle : rays.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const AxialLine& one = lines[triangle[i]];
            const AxialLine& other = lines[triangle[(i + 1) % 3]];
            width = std::max(width, (one.at(neck) - other.at(neck)).norm());
            spreading = std::max(spreading, (one.slope - other.slope).norm());
        }
    const Vec3d centre = origin + neck * a + circle.centre.x() * s + circle.centre.y() * t;
    const double size = centre.cwiseAbs().maxCoeff();
    cone.neck = centre.cast<float>();
    cone.axis = a.cast<float>();
    cone.radius = static_cast<float>(circle.radius * (1 + 1e-6) + 1e-6 * size);
    cone.tangent = static_cast<float>(tangent * (1 + 1e-6) + 1e-6);
    cone.nearest = static_cast<float>(first - neck - 1e-6 * (std::abs(first - neck) + size));
    cone.width = static_cast<float>(width * (1 + 1e-6));
    cone.spreading = static_cast<float>(spreading * (1 + 1e-6) + 1e-7);
    return cone;
}

}  // namespace caustics::beamtree

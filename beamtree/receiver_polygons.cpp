#include "beamtree/receiver_polygons.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "beamtree/beams/caster_mesh.h"
#include "core/geometry/tessellate.h"

namespace caustics::beamtree {
namespace {

Vec3 middle(const ReceiverPolygon& p) { return (p.a + p.b + p.c) / 3; }

double squared_distance_to_edge(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const Vec3d edge = b - a;
    const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    return (p - a - t * edge).squaredNorm();
}

double squared_distance(const Vec3d& p, const ReceiverPolygon& polygon) {
    const Vec3d a = polygon.a.cast<double>();
    const Vec3d b = polygon.b.cast<double>();
    const Vec3d c = polygon.c.cast<double>();
    const Vec3d n = (b - a).cross(c - a);
    const bool inside = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                        n.dot((a - c).cross(p - c)) >= 0;
    if (inside) return std::pow(n.dot(p - a), 2) / n.squaredNorm();
    return std::min({squared_distance_to_edge(p, a, b), squared_distance_to_edge(p, b, c),
                     squared_distance_to_edge(p, c, a)});
}

// Eight float spacings of the largest coordinate: half of one for each of the corners and the point,
// and as much again for what was computed between them.
double rounding_of(const Box& box) {
    const float largest =
        std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
    return 8 * static_cast<double>(std::numeric_limits<float>::epsilon() * largest);
}

// Cosines of normals that differ by less tell nothing.
constexpr float least_misfit = 1e-4F;

}  // namespace

double position_rounding(const ReceiverPolygon& polygon) {
    Box box(polygon.a);
    return rounding_of(box.extend(polygon.b).extend(polygon.c));
}

ReceiverPolygons::ReceiverPolygons(const Scene& scene, int resolution) {
    for (const Shape& shape : scene.shapes()) {
        if (!is_receiver(shape.bsdf)) continue;
        const TriangleMesh mesh = tessellate_shape(shape, resolution);
        for (const auto& [i, j, k] : mesh.triangles) {
            ReceiverPolygon polygon{mesh.positions[i], mesh.positions[j], mesh.positions[k],
                                    Vec3::Zero()};
            polygon.normal = triangle_normal(polygon.a, polygon.b, polygon.c);
            if (!polygon.normal.isZero(0)) polygons_.push_back(polygon);
        }
    }
    build_tree();
}

void ReceiverPolygons::build_tree() {
    constexpr std::uint32_t leaf_size = 4;
    if (polygons_.empty()) return;
    nodes_.push_back({Box(), 0, static_cast<std::uint32_t>(polygons_.size())});
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const std::uint32_t first = nodes_[i].first;
        const std::uint32_t count = nodes_[i].count;
        Box middles;
        for (std::uint32_t k = first; k < first + count; ++k) {
            const ReceiverPolygon& polygon = polygons_[k];
            for (const Vec3& p : {polygon.a, polygon.b, polygon.c}) nodes_[i].box.extend(p);
            middles.extend(middle(polygon));
        }
        if (count <= leaf_size) continue;
        int axis = 0;
        middles.sizes().maxCoeff(&axis);
        const auto begin = polygons_.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count,
                         [axis](const ReceiverPolygon& p, const ReceiverPolygon& q) {
                             return middle(p)[axis] < middle(q)[axis];
                         });
        nodes_[i].first = static_cast<std::uint32_t>(nodes_.size());
        nodes_[i].count = 0;
        nodes_.push_back({Box(), first, count / 2});
        nodes_.push_back({Box(), first + count / 2, count - count / 2});
    }
}

std::uint32_t ReceiverPolygons::nearest(const Vec3& point, const Vec3& normal,
                                        std::vector<std::uint32_t>& stack) const {
    const Vec3d p = point.cast<double>();
    double best = std::numeric_limits<double>::infinity();
    float best_fit = -1;
    std::uint32_t found = 0;
    stack.assign(1, 0);
    while (!stack.empty()) {
        const Node& node = nodes_[stack.back()];
        stack.pop_back();
        if (static_cast<double>(node.box.exteriorDistance(point)) >
            best + 2 * rounding_of(node.box))
            continue;
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            const double distance = std::sqrt(squared_distance(p, polygons_[k]));
            const double close = position_rounding(polygons_[k]);
            const float fit = std::abs(polygons_[k].normal.dot(normal));
            // Of two that fit alike, one above the other, the nearer one.
            const bool fits_better =
                fit > best_fit + least_misfit || (fit > best_fit - least_misfit && distance < best);
            if (distance > best + close || (distance > best - close && !fits_better)) continue;
            best = std::min(best, distance);
            best_fit = fit;
            found = k;
        }
        if (node.count > 0) continue;
        stack.push_back(node.first);
        stack.push_back(node.first + 1);
    }
    return found;
}

}  // namespace caustics::beamtree

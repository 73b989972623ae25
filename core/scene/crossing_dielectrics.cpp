#include "core/scene/crossing_dielectrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "core/geometry/tessellate.h"

namespace caustics {
namespace {

constexpr int resolution = 16;
constexpr std::size_t most_edges = 10'000;  // of a shape
constexpr float margin =
    0.03F;  // of an edge: so far from either end, and from the rim of what it crosses
constexpr float least_sine = 0.17F;  // between an edge and the surface it crosses

using Crossing = std::pair<std::uint32_t, std::uint32_t>;

bool is_dielectric(const Shape& shape) {
    return std::holds_alternative<Dielectric>(shape.bsdf.model);
}

class CrossingSearch {
public:
    explicit CrossingSearch(const Scene& scene) : scene_(scene) {
        for (std::uint32_t i = 0; i < scene.shapes().size(); ++i)
            if (is_dielectric(scene.shapes()[i])) boxes_.emplace_back(i, bounds(scene.shapes()[i]));
    }

    std::vector<Crossing> run() {
        if (boxes_.size() > 1)
            for (const auto& [shape, box] : boxes_) walk_edges(shape);
        std::ranges::sort(found_);
        return std::move(found_);
    }

private:
    void walk_edges(std::uint32_t index) {
        shape_ = index;
        const Shape& shape = scene_.shapes()[index];
        if (shape.primitive == Primitive::mesh)
            walk_edges(shape.mesh);
        else
            walk_edges(tessellate_shape(shape, resolution));
    }
    void walk_edges(const TriangleMesh& mesh) {
        const std::size_t stride = 1 + 3 * mesh.triangles.size() / most_edges;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += stride)
            for (std::size_t k = 0; k < 3; ++k)
                walk_edge(mesh.positions[mesh.triangles[i][k]],
                          mesh.positions[mesh.triangles[i][(k + 1) % 3]]);
    }

    bool comes_near_another(const Vec3& a, const Vec3& b) const {
        const Box edge(a.cwiseMin(b), a.cwiseMax(b));
        return std::ranges::any_of(boxes_, [&](const auto& other) {
            return other.first != shape_ && other.second.intersects(edge);
        });
    }

    // Calls `visit` with the surfaces on the way, one after the other, until it returns false.
    template <typename Visit>
    void walk(const Vec3& from, const Vec3& direction, float length, const Visit& visit) const {
        float gone = 0;
        while (gone < length) {
            Ray ray{from + gone * direction, direction};
            ray.max_distance = length - gone;
            const std::optional<SurfacePoint> hit = scene_.intersect(ray);
            if (!hit || !visit(*hit)) return;
            gone += hit->distance + std::max(margin * length, 4 * hit->offset);
        }
    }

    void walk_edge(const Vec3& a, const Vec3& b) {
        const float length = (b - a).norm();
        if (!(length > 0) || !comes_near_another(a, b)) return;
        const Vec3 direction = (b - a) / length;
        walk(a + margin * length * direction, direction, (1 - 2 * margin) * length,
             [&](const SurfacePoint& hit) {
                 if (crosses(hit, direction, margin * length)) {
                     const Crossing pair = std::minmax(shape_, hit.shape);
                     if (std::ranges::find(found_, pair) == found_.end()) found_.push_back(pair);
                 }
                 return true;
             });
    }

    bool crosses(const SurfacePoint& hit, const Vec3& direction, float room) const {
        if (hit.shape == shape_ || !is_dielectric(scene_.shape_at(hit)) ||
            std::abs(hit.geometric_normal.dot(direction)) < least_sine)
            return false;
        const Vec3 side = direction.unitOrthogonal();
        const Vec3 other_side = direction.cross(side);
        return std::ranges::all_of(
            std::array<Vec3, 4>{side, -side, other_side, -other_side}, [&](const Vec3& aside) {
                const float reach = room / least_sine;
                return is_at(hit.shape, hit.position + room * aside - reach * direction, direction,
                             2 * reach);
            });
    }

    bool is_at(std::uint32_t shape, const Vec3& from, const Vec3& direction, float length) const {
        bool found = false;
        walk(from, direction, length, [&](const SurfacePoint& hit) {
            found = hit.shape == shape;
            return !found;
        });
        return found;
    }

    const Scene& scene_;
    std::vector<std::pair<std::uint32_t, Box>> boxes_;  ///< of the dielectrics
    std::uint32_t shape_ = 0;                           ///< whose edges are walked
    std::vector<Crossing> found_;
};

}  // namespace

std::vector<Crossing> crossing_dielectrics(const Scene& scene) {
    return CrossingSearch(scene).run();
}

}  // namespace caustics

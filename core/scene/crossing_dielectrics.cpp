#include "core/scene/crossing_dielectrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "core/geometry/box_tree.h"
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

std::vector<std::uint32_t> dielectrics_of(const Scene& scene) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < scene.shapes().size(); ++i)
        if (is_dielectric(scene.shapes()[i])) all.push_back(i);
    return all;
}

BoxTree dielectric_boxes(const Scene& scene, const std::vector<std::uint32_t>& shapes) {
    std::vector<Box> boxes;
    for (const std::uint32_t shape : shapes) boxes.push_back(bounds(scene.shapes()[shape]));
    return BoxTree(std::move(boxes));
}

// A shape's bounds with room for the roundings of its mesh.
Box wide_bounds(const Shape& shape) {
    constexpr float room = 1e-3F;  // of the diagonal
    const Box box = bounds(shape);
    const Vec3 aside = Vec3::Constant(room * box.diagonal().norm());
    return {box.min() - aside, box.max() + aside};
}

class CrossingSearch {
public:
    explicit CrossingSearch(const Scene& scene)
        : scene_(scene),
          dielectrics_(dielectrics_of(scene)),
          boxes_(dielectric_boxes(scene, dielectrics_)) {}

    std::vector<Crossing> run() {
        for (const std::uint32_t shape : dielectrics_) {
            if (found_.size() >= most_crossing_pairs) break;
            shape_ = shape;
            if (meets_another(wide_bounds(scene_.shapes()[shape]))) walk_edges(shape);
        }
        return {found_.begin(), found_.end()};
    }

private:
    void walk_edges(std::uint32_t index) {
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

    bool meets_another(const Box& box) const {
        return boxes_.any_at(box, [&](std::uint32_t i) { return dielectrics_[i] != shape_; });
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
        if (!(length > 0) || found_.size() >= most_crossing_pairs ||
            !meets_another({a.cwiseMin(b), a.cwiseMax(b)}))
            return;
        const Vec3 direction = (b - a) / length;
        walk(a + margin * length * direction, direction, (1 - 2 * margin) * length,
             [&](const SurfacePoint& hit) {
                 if (crosses(hit, direction, margin * length))
                     found_.insert(std::minmax(shape_, hit.shape));
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
    std::vector<std::uint32_t> dielectrics_;
    BoxTree boxes_;            ///< of the dielectrics
    std::uint32_t shape_ = 0;  ///< whose edges are walked
    std::set<Crossing> found_;
};

}  // namespace

std::vector<Crossing> crossing_dielectrics(const Scene& scene) {
    return CrossingSearch(scene).run();
}

}  // namespace caustics

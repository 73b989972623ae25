#include "core/scene/shared_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "core/base/interrupt.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/tessellate.h"
#include "core/mesh/triangle_middles.h"
#include "core/scene/intersector.h"
#include "core/scene/placed_surfaces.h"

namespace caustics {
namespace {

constexpr std::size_t most_middles = 4000;  // of a shape
constexpr std::size_t most_triangles = 200'000;
constexpr float reach_share = 1e-4F;  // of the caster's diagonal: how far off its face others are
constexpr float least_cosine = 0.99F;

BoxTree boxes_of(const Scene& scene) {
    std::vector<Box> boxes;
    for (const Shape& shape : scene.shapes()) boxes.push_back(bounds(shape));
    return BoxTree(std::move(boxes));
}

Box widened(const Box& box, float by) {
    const Vec3 aside = Vec3::Constant(by);
    return {box.min() - aside, box.max() + aside};
}

bool is_large(const Shape& shape) { return shape.mesh.triangles.size() > most_triangles; }

/// Of a caster's faces; none where triangles do not lie on it.
std::vector<TriangleMiddle> middles_of(const Shape& shape) {
    if (is_large(shape)) return {};
    if (shape.primitive == Primitive::mesh) return triangle_middles(shape.mesh, most_middles);
    if (shape.primitive == Primitive::rectangle || shape.primitive == Primitive::disk)
        return triangle_middles(tessellate_shape(shape, 8), most_middles);
    return {};
}

class FaceSearch {
public:
    explicit FaceSearch(const Scene& scene) : scene_(scene), boxes_(boxes_of(scene)) {}

    std::vector<SharedFace> run() {
        for (std::uint32_t i = 0; i < scene_.shapes().size(); ++i)
            if (is_caster(scene_.shapes()[i].bsdf)) search(i);
        std::vector<SharedFace> faces;
        for (const auto& [caster, other] : found_) faces.push_back({caster, other});
        return faces;
    }

private:
    void search(std::uint32_t caster) {
        throw_if_interrupted();
        const Shape& shape = scene_.shapes()[caster];
        const std::vector<TriangleMiddle> middles = middles_of(shape);
        if (middles.empty()) return;
        const Box box = bounds(shape);
        const float reach = reach_share * box.diagonal().norm();
        boxes_.any_at(widened(box, reach), [&](std::uint32_t other) {
            if (other != caster && !is_large(scene_.shapes()[other]) &&
                !found_.contains({other, caster}) && lie_on(middles, other, reach))
                found_.emplace(caster, other);
            return false;
        });
    }

    bool lie_on(const std::vector<TriangleMiddle>& middles, std::uint32_t other,
                float reach) const {
        const std::vector<Shape>& all = scene_.shapes();
        const Box box = widened(bounds(all[other]), reach);
        const auto is_near = [&](const TriangleMiddle& middle) {
            return box.contains(middle.place);
        };
        if (std::ranges::none_of(middles, is_near)) return false;
        const auto touched_by = [&](const auto& meet) {
            return std::ranges::any_of(middles, [&](const TriangleMiddle& middle) {
                return is_near(middle) && is_at(meet, middle, reach);
            });
        };
        if (all[other].primitive != Primitive::mesh) {
            const PlacedExact exact(all[other]);
            return touched_by([&](const Ray& ray) { return exact.meet(ray); });
        }
        const std::vector<Shape> alone = {all[other]};
        const Intersector mesh(alone);
        return touched_by([&](const Ray& ray) { return mesh.intersect(ray); });
    }

    template <class Meet>
    static bool is_at(const Meet& meet, const TriangleMiddle& middle, float reach) {
        Ray ray{middle.place + reach * middle.normal, -middle.normal};
        ray.max_distance = 2 * reach;
        const std::optional<SurfacePoint> met = meet(ray);
        return met && std::abs(met->distance - reach) <= 2 * met->offset &&
               std::abs(met->geometric_normal.dot(middle.normal)) >= least_cosine;
    }

    const Scene& scene_;
    BoxTree boxes_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> found_;  ///< caster, other
};

}  // namespace

std::vector<SharedFace> shared_faces(const Scene& scene) { return FaceSearch(scene).run(); }

}  // namespace caustics

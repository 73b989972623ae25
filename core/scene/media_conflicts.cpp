#include "core/scene/media_conflicts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/interrupt.h"
#include "core/geometry/tessellate.h"
#include "core/mesh/triangle_middles.h"
#include "core/scene/intersector.h"

namespace caustics {
namespace {

constexpr int resolution = 12;               // of exact shapes
constexpr std::size_t most_rays = 400;       // of a shape
constexpr std::size_t most_in_all = 40'000;  // shared by all shapes
constexpr double least_share = 0.1;          // of a shape's rays
constexpr double alike = 0.01;
constexpr float reach_of_mesh =
    1e-3F;  // of the diagonal: how far off a triangle its surface is looked for
constexpr float reach_of_exact = 0.1F;

using Pair = std::pair<std::uint32_t, std::uint32_t>;

const Dielectric* dielectric_of(const Shape& shape) {
    return std::get_if<Dielectric>(&shape.bsdf.model);
}

const Ior& ior_of(const Dielectric& of, bool outside) { return outside ? of.ext_ior : of.int_ior; }

bool agree(const Dielectric& a, bool a_outside, const Dielectric& b, bool b_outside, float length) {
    const double n = ior_of(a, a_outside).n();
    if (std::abs(ior_of(b, b_outside).n() - n) > alike * n) return false;
    const Spectrum apart = (a.medium(a_outside) - b.medium(b_outside)).abs() * length;
    return static_cast<double>(apart.maxCoeff()) <= alike;
}

/// Off one shape, to both sides.
class ShapeRays {
public:
    ShapeRays(const Scene& scene, std::uint32_t index, std::size_t most)
        : scene_(scene), index_(index), shape_(scene.shapes()[index]), most_(most) {}

    void run(std::map<Pair, MediaConflict>& found) {
        const bool is_mesh = shape_.primitive == Primitive::mesh;
        const TriangleMesh own = is_mesh ? TriangleMesh() : tessellate_shape(shape_, resolution);
        if (!is_mesh) {
            copy_ = {shape_};
            alone_.emplace(copy_);
        }
        const float reach =
            (is_mesh ? reach_of_mesh : reach_of_exact) * bounds(shape_).diagonal().norm();
        for (const TriangleMiddle& middle : triangle_middles(is_mesh ? shape_.mesh : own, most_))
            look_from(middle, reach);
        for (const auto& [pair, conflict] : conflicts_)
            if (static_cast<double>(counts_[pair]) >= least_share * static_cast<double>(places_))
                found.emplace(pair, conflict);
    }

private:
    void look_from(const TriangleMiddle& middle, float reach) {
        Ray ray{middle.place + reach * middle.normal, -middle.normal};
        ray.max_distance = 2 * reach;
        const auto at = alone_ ? alone_->intersect(ray) : scene_.intersect(ray);
        if (!at || (!alone_ && at->shape != index_)) return;
        ++places_;
        for (const bool outside : {true, false}) look(*at, outside);
    }

    void look(const SurfacePoint& from, bool outside) {
        const Vec3 direction = outside ? from.geometric_normal : Vec3(-from.geometric_normal);
        const auto hit = scene_.intersect(
            spawn_ray({from.position, from.geometric_normal, from.offset}, direction));
        if (!hit || hit->shape == index_) return;
        const Dielectric* const other = dielectric_of(scene_.shape_at(*hit));
        const Dielectric& own = *dielectric_of(shape_);
        const bool other_outside = hit->geometric_normal.dot(direction) < 0;
        if (other == nullptr || agree(own, outside, *other, other_outside, hit->distance)) return;
        MediaConflict conflict{index_, hit->shape, ior_of(own, outside).n(),
                               ior_of(*other, other_outside).n()};
        if (conflict.first > conflict.second) {
            std::swap(conflict.first, conflict.second);
            std::swap(conflict.first_ior, conflict.second_ior);
        }
        const Pair pair(conflict.first, conflict.second);
        conflicts_.emplace(pair, conflict);
        ++counts_[pair];
    }

    const Scene& scene_;
    std::uint32_t index_;
    const Shape& shape_;
    std::size_t most_;
    std::vector<Shape> copy_;           ///< of an exact shape; `alone_` refers to it
    std::optional<Intersector> alone_;  ///< of an exact shape
    std::size_t places_ = 0;
    std::map<Pair, MediaConflict> conflicts_;
    std::map<Pair, std::size_t> counts_;
};

}  // namespace

std::vector<MediaConflict> media_conflicts(const Scene& scene) {
    std::vector<std::uint32_t> dielectrics;
    for (std::uint32_t i = 0; i < scene.shapes().size(); ++i)
        if (dielectric_of(scene.shapes()[i]) != nullptr) dielectrics.push_back(i);
    if (dielectrics.size() < 2) return {};
    const std::size_t most =
        std::clamp<std::size_t>(most_in_all / dielectrics.size(), 8, most_rays);
    std::map<Pair, MediaConflict> found;
    for (const std::uint32_t i : dielectrics) {
        throw_if_interrupted();
        ShapeRays(scene, i, most).run(found);
    }
    std::vector<MediaConflict> conflicts;
    for (const auto& [pair, conflict] : found) conflicts.push_back(conflict);
    return conflicts;
}

}  // namespace caustics

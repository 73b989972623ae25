#include "core/scene/media_conflicts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/interrupt.h"
#include "core/geometry/tessellate.h"
#include "core/mesh/triangle_middles.h"
#include "core/scene/placed_surfaces.h"

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

/// Triangles of shapes to look from, at most so many of each.
class Triangles {
public:
    explicit Triangles(std::size_t most) : most_(most), meshes_(resolution) {}

    /// In the world frame.
    std::vector<TriangleMiddle> middles(const Shape& shape) {
        const TriangleMesh& mesh = meshes_.of(shape);
        if (shape.primitive == Primitive::mesh) return triangle_middles(mesh, most_);
        TriangleMesh some;
        const std::size_t stride = 1 + mesh.triangles.size() / most_;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
            const auto first = static_cast<std::uint32_t>(some.positions.size());
            for (const std::uint32_t corner : mesh.triangles[i])
                some.positions.push_back(mesh.positions[corner]);
            some.triangles.push_back({first, first + 1, first + 2});
        }
        place_exact(some, shape);
        return triangle_middles(some, most_ + 1);
    }

private:
    std::size_t most_;
    OwnFrameMeshes meshes_;
};

/// Off one shape, to both sides.
class ShapeRays {
public:
    ShapeRays(const Scene& scene, std::uint32_t index)
        : scene_(scene), index_(index), shape_(scene.shapes()[index]) {
        if (shape_.primitive != Primitive::mesh) alone_.emplace(shape_);
    }

    void run(const std::vector<TriangleMiddle>& middles, std::map<Pair, MediaConflict>& found) {
        const float reach =
            (alone_ ? reach_of_exact : reach_of_mesh) * bounds(shape_).diagonal().norm();
        for (const TriangleMiddle& middle : middles) look_from(middle, reach);
        for (const auto& [pair, conflict] : conflicts_)
            if (static_cast<double>(counts_[pair]) >= least_share * static_cast<double>(places_))
                found.emplace(pair, conflict);
    }

private:
    void look_from(const TriangleMiddle& middle, float reach) {
        Ray ray{middle.place + reach * middle.normal, -middle.normal};
        ray.max_distance = 2 * reach;
        const auto at = alone_ ? alone_->meet(ray) : scene_.intersect(ray);
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
    std::optional<PlacedExact> alone_;  ///< of an exact shape
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
    Triangles triangles(most);
    std::map<Pair, MediaConflict> found;
    for (const std::uint32_t i : dielectrics) {
        throw_if_interrupted();
        ShapeRays(scene, i).run(triangles.middles(scene.shapes()[i]), found);
    }
    std::vector<MediaConflict> conflicts;
    for (const auto& [pair, conflict] : found) conflicts.push_back(conflict);
    return conflicts;
}

}  // namespace caustics

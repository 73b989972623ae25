#pragma once

#include <array>
#include <optional>

#include "beamtree/beams/beam.h"
#include "beamtree/light/light_chain.h"

namespace caustics::beamtree {

/// The first surface of a set's light: an exact shape; empty for a mesh, whose triangles are surfaces of their own.
inline std::optional<SpecularSurface> first_exact_surface(const Scene& scene, const BeamSet& set) {
    const Shape& shape = scene.shapes()[set.caster];
    if (shape.primitive == Primitive::mesh) return {};
    return SpecularSurface(shape);
}

/// One of a beam's triangles on the first surface: its places are those beside corner + u side + v side.
class FirstPolygon {
public:
    /// `exact` is first_exact_surface(); all outlive this.
    FirstPolygon(const Scene& scene, const BeamSet& set,
                 const std::optional<SpecularSurface>& exact, const Beam& beam, std::size_t which)
        : offset_(beam.offset) {
        if (exact)
            surface_ = &*exact;
        else
            surface_ = &facet_.emplace(scene.shapes()[set.caster].mesh, beam.mesh_triangle(which));
        const std::array<std::uint32_t, 3> corners = beam.triangle_corners(which);
        const auto local = [&](std::size_t i) {
            return surface_->local(set.origin(corners[i]).cast<double>());
        };
        corner_ = local(0);
        sides_ = {local(1) - corner_, local(2) - corner_};
        const Vec3& from = set.origin(corners[0]);
        size_ = static_cast<double>(std::max((set.origin(corners[1]) - from).norm(),
                                             (set.origin(corners[2]) - from).norm()));
    }
    FirstPolygon(const FirstPolygon&) = delete;
    FirstPolygon& operator=(const FirstPolygon&) = delete;

    ChainStart start(const Vec2d& at) const {
        return {*surface_, corner_ + at.x() * sides_[0] + at.y() * sides_[1], sides_, offset_};
    }

    /// A place of the straight-sided polygon, in the scene's frame.
    Vec3d position(const Vec2d& at) const {
        return surface_->world(corner_ + at.x() * sides_[0] + at.y() * sides_[1]);
    }
    /// About how long its sides are [m].
    double size() const { return size_; }

private:
    std::optional<SpecularSurface> facet_;
    const SpecularSurface* surface_;
    Vec3d corner_;
    std::array<Vec3d, 2> sides_;
    double size_;
    float offset_;
};

}  // namespace caustics::beamtree

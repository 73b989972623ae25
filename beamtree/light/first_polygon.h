#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/lit_caster.h"
#include "beamtree/light/light_chain.h"
#include "core/geometry/surface_offset.h"

namespace caustics::beamtree {

/// The first surface of a set's light: an exact shape; empty for a mesh, whose triangles are surfaces of their own.
inline std::optional<SpecularSurface> first_exact_surface(const Scene& scene, const BeamSet& set) {
    const Shape& shape = scene.shapes()[set.caster];
    if (shape.primitive == Primitive::mesh) return {};
    return SpecularSurface(shape);
}

/// True where a set's light meets a mesh after its first event: neighbouring rays may meet different facets.
inline bool meets_mesh_after_first(const Scene& scene, const BeamSet& set) {
    return std::any_of(set.path.begin() + 1, set.path.end(), [&](const SpecularEvent& event) {
        return scene.shapes()[event.shape].primitive == Primitive::mesh;
    });
}

/// Where the corners of one of a beam's triangles lie on the first surface's mesh.
inline std::array<Vec3, 3> first_corners(const BeamSet& set, const Beam& beam, std::size_t which) {
    const auto [a, b, c] = beam.triangle_corners(which);
    return {set.origin(a), set.origin(b), set.origin(c)};
}

/// A triangle on the first surface: its places are those beside corner + u side + v side.
class FirstPolygon {
public:
    /// One of a beam's triangles, which has these corners. `exact` is first_exact_surface(); all outlive this.
    FirstPolygon(const Scene& scene, const BeamSet& set,
                 const std::optional<SpecularSurface>& exact, const Beam& beam, std::size_t which,
                 const std::array<Vec3, 3>& corners)
        : side_(beam.front ? 1 : -1) {
        const Shape& shape = scene.shapes()[set.caster];
        if (exact) {
            surface_ = &*exact;
            offset_ = least_offset(shape);
            for (const Vec3& corner : corners) offset_ = std::max(offset_, rounding_offset(corner));
        } else {
            surface_ = &facet_.emplace(shape.mesh, beam.mesh_triangle(which));
            offset_ = corner_offset(shape.mesh, beam.mesh_triangle(which));
        }
        const auto local = [&](std::size_t i) {
            return surface_->local(corners[i].cast<double>());
        };
        corner_ = local(0);
        sides_ = {local(1) - corner_, local(2) - corner_};
        size_ = static_cast<double>(
            std::max((corners[1] - corners[0]).norm(), (corners[2] - corners[0]).norm()));
    }
    FirstPolygon(const Scene& scene, const BeamSet& set,
                 const std::optional<SpecularSurface>& exact, const Beam& beam, std::size_t which)
        : FirstPolygon(scene, set, exact, beam, which, first_corners(set, beam, which)) {}
    FirstPolygon(const FirstPolygon&) = delete;
    FirstPolygon& operator=(const FirstPolygon&) = delete;

    ChainStart start(const Vec2d& at) const {
        return {*surface_, corner_ + at.x() * sides_[0] + at.y() * sides_[1], sides_, offset_,
                side_};
    }

    /// A place of the straight-sided polygon, in the scene's frame.
    Vec3d position(const Vec2d& at) const {
        return surface_->world(corner_ + at.x() * sides_[0] + at.y() * sides_[1]);
    }
    /// The coordinates of a place in its plane, which is given in the scene's frame.
    Vec2d coordinates(const Vec3d& position) const {
        const Vec3d way = surface_->local(position) - corner_;
        const Vec3d normal = sides_[0].cross(sides_[1]);
        return Vec2d(normal.dot(way.cross(sides_[1])), normal.dot(sides_[0].cross(way))) /
               normal.squaredNorm();
    }
    /// About how long its sides are [m].
    double size() const { return size_; }

private:
    std::optional<SpecularSurface> facet_;
    const SpecularSurface* surface_;
    Vec3d corner_;
    std::array<Vec3d, 2> sides_;
    double size_;
    float offset_;  ///< of rays that leave the surface [m], whatever Beam::offset is
    double side_;   ///< ChainStart::side
};

}  // namespace caustics::beamtree

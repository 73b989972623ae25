#pragma once

#include <array>
#include <optional>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/specular_vertex.h"
#include "beamtree/light/specular_surface.h"

namespace caustics::beamtree {

/// Where a surface bends light so that it reaches a given point, and how dense it is there.
struct SpecularPoint {
    Vec3 position;              ///< on the surface
    Vec3 normal;                ///< unit, the surface's front side
    Vec3 direction;             ///< unit, the way from there to the point
    Spectrum weight = black();  ///< strength of the light after the event
    double density = 0;         ///< of `measure` for an area across the direction [sr m^-2, or 1]
};

/// Finds specular points of exact shapes and of flat facets of meshes, for the light of one beam set: the
/// specular point and its energy that [CC95 sec. 5] leave for later. What is not a matter of polygons is
/// exact to rounding.
class SpecularSearch {
public:
    /// Scene and set outlive this; the set's light has met one caster.
    SpecularSearch(const Scene& scene, const BeamSet& set);

    /// By Newton's method from the place and direction of `guess`, the ray of one of a beam's triangles whose
    /// light reaches the point by [CC95 (11)]. Empty where it does not converge nearby, or finds a
    /// ray of the other side of a caustic, and on meshes where they are smooth.
    std::optional<SpecularPoint> find(const Beam& beam, std::size_t triangle,
                                      const VertexRay& guess, const Vec3& point) const;

private:
    struct Exit;
    struct Derivatives;
    struct Image;
    class Sheet;

    std::optional<SpecularPoint> find(const SpecularSurface& surface,
                                      const std::array<const VertexRay*, 3>& triangle,
                                      const VertexRay& guess, const Vec3& point) const;
    std::optional<Exit> exit_at(const SpecularSurface& surface, const Vec3d& local) const;
    Vec3d direction_change(const Exit& exit, const Vec3d& by_position,
                           const Vec3d& by_normal) const;
    Derivatives derivatives(const Sheet& sheet, const Vec3d& local, const Exit& exit) const;
    double miss_rounding(const Vec3d& local, const Exit& exit, const Derivatives& found) const;
    std::optional<Image> image(const Sheet& sheet,
                               const std::array<const VertexRay*, 3>& triangle) const;
    SpecularPoint made(const Sheet& sheet, const Exit& exit, const Derivatives& found) const;

    const BeamSet& set_;
    const LightSample& light_;
    const Shape& shape_;
    LightBender bender_;
    Event event_;
    std::optional<SpecularSurface> exact_;  ///< empty for a mesh
};

}  // namespace caustics::beamtree

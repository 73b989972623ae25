#pragma once

#include <array>
#include <cstdint>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/specular_vertex.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// How a ray starts: off the surface it leaves, by that surface's normal.
struct Departure {
    Vec3 normal;                       ///< unit
    float offset = 0;                  ///< [m]
    const Spectrum* medium = nullptr;  ///< absorption where the ray goes [1/m]; null: none is known
};

/// Where a ray next meets a surface, and what becomes of its light there if that is a caster.
struct RayArrival {
    static constexpr std::uint32_t nothing = ~0U;
    std::uint32_t shape = nothing;  ///< of a caster; a ray that ends elsewhere has none
    bool front = false;             ///< it arrives on the front side
    bool flat = false;              ///< on a mesh's facet that is shaded flat
    Vec3 position;
    Vec3 geometric_normal;
    Vec3 shading_normal;
    float offset = 0;
    std::array<Vec3, 2> direction;
    /// After each event, over the weight before: of surface and way there.
    std::array<Spectrum, 2> weight = {black(), black()};
    float left = 1;  ///< by the medium on the way there, mean of the channels
    std::array<const Spectrum*, 2> medium = {};  ///< after each event, as Departure::medium

    bool goes_on() const { return shape != nothing; }
    Departure after(Event event) const { return {geometric_normal, offset, medium[event]}; }
};

/// Sends a ray of light of a wavelength [nm], or of all (0), on.
RayArrival land(const Scene& scene, const VertexRay& ray, const Departure& from, float nm);

/// Whether two rays have met one side of one piece of a surface, without a crease or a step between:
/// facets that are shaded flat are one piece if they lie in one plane, and elsewhere normals of one
/// piece turn by less than 40 degrees from one ray to the other and are across the way between the
/// two. Two rays that meet no caster are alike too.
bool same_piece(const RayArrival& a, const RayArrival& b);
/// Whether two rays that have met one piece have met one facet of it, where it is shaded flat: a piece may be many
/// that turn by little each.
bool same_facet(const RayArrival& a, const RayArrival& b);

}  // namespace caustics::beamtree

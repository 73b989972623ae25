#pragma once

#include <array>
#include <optional>

#include "beamtree/beams/beam.h"
#include "beamtree/beams/specular_vertex.h"
#include "beamtree/light/specular_surface.h"

namespace caustics::beamtree {

/// A place on the first specular surface from which a chain starts, and two ways along which it may move.
struct ChainStart {
    const SpecularSurface& surface;
    Vec3d local;                ///< beside the surface, in its frame
    std::array<Vec3d, 2> ways;  ///< in its frame
    float offset;               ///< of rays that leave the place [m]
    double side;  ///< 1 if the light comes to the front of the surface, -1 if to the back
};

/// A ray of light that has left the last surface of a chain, with its derivatives by the two ways of the start.
struct ChainRay {
    SpecularSurface::Place first;  ///< where the light met the first surface
    Vec3d to_light;                ///< unit, from there
    double light_area =
        0;             ///< parallelogram of the two ways as the light sees it: solid angle [sr], or
                       ///< area across a directional light [m^2]
    Vec3d position;    ///< on the last surface
    Vec3d across;      ///< unit geometric normal there
    float offset = 0;  ///< of rays that leave it [m]
    Vec3d direction;   ///< unit
    /// Changes where the light meets another of the facets that are shaded flat, after the first surface.
    Vec3d facets = Vec3d::Zero();
    std::array<Vec3d, 2> by_position;
    std::array<Vec3d, 2> by_direction;
};

/// The way of one set's light through its specular events, in double: what maps a place of the first surface to a
/// ray behind the last one, as specular manifolds do (Jakob and Marschner 2012). Exact shapes are solved exactly;
/// on meshes positions lie on the triangles, and light is bent by the interpolated normals, as every method does.
class LightChain {
public:
    /// Scene and set outlive this.
    LightChain(const Scene& scene, const BeamSet& set);

    /// Empty where light from there does not go the set's way: total reflection, another surface first, or none.
    std::optional<ChainRay> ray(const ChainStart& start) const;
    /// The strength of the light along that way, times all weights of its events and the media between them
    /// (to be multiplied by light_area); black where something stands in the way, between the light and the first
    /// surface as well, or where shading normals lose the light.
    Spectrum weight(const ChainStart& start) const;

private:
    struct Bend;
    /// Light that has come to an event.
    struct Arrival {
        const Shape* shape;
        SpecularSurface::Place place;
        Vec3d w;             ///< unit, towards where the light comes from
        double distance;     ///< that it has come [m]
        float offset;        ///< of rays that leave the place [m]
        std::size_t number;  ///< of the event, from 0
        bool is_seen;        ///< a traced ray has come from the place before
        /// Derivatives of w and of the shading normal by the ways of the start.
        std::array<Vec3d, 2> by_w;
        std::array<Vec3d, 2> by_normal;
    };
    Arrival first_arrival(const ChainStart& start, ChainRay& ray) const;
    std::optional<Arrival> next_arrival(const Arrival& before, ChainRay& ray) const;
    std::optional<Bend> bend(const Arrival& arrival) const;
    bool leave(const Arrival& arrival, const Bend& bend, ChainRay& ray) const;
    template <typename Visit>
    std::optional<ChainRay> go(const ChainStart& start, const Visit& visit) const;

    const Scene& scene_;
    const BeamSet& set_;
    const LightSample& light_;
    LightBender bender_;
    /// One an event: the exact shape that it happens on; empty for a mesh.
    std::vector<std::optional<SpecularSurface>> exact_;
    std::vector<double> least_;  ///< one an event: how far a ray goes at least before it [m]
};

}  // namespace caustics::beamtree

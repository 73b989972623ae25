#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/light_sample.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics::beamtree {

/// What a specular surface has made of the light at one vertex: a ray that leaves it.
struct VertexRay {
    Vec3 position;
    Vec3 direction;  ///< unit, the way the light goes
};

/// How the light round a ray spreads: at the distance s [m] it makes 1 / |constant + linear s +
/// quadratic s^2| [W m^-2, mean of channels] on a surface across the ray. The sign changes where the
/// light passes through a caustic. All 0: not known.
struct RaySpread {
    float constant = 0;   ///< [m^2 W^-1]; 0 or more
    float linear = 0;     ///< [m W^-1]
    float quadratic = 0;  ///< [W^-1]

    bool is_known() const { return constant > 0; }
    double at(double s) const {
        return static_cast<double>(constant) +
               s * (static_cast<double>(linear) + s * static_cast<double>(quadratic));
    }
};

/// The light that one specular polygon sends on [CC95 sec. 3.1]: rays through its three or four
/// corners (a triangle, what is left of one, or a cell of a grid), and the flux they enclose. Four
/// corners are two triangles, (0, 1, 2) and (0, 2, 3). After several events the rays start where the
/// light of the polygon's corners was bent last.
struct Beam {
    static constexpr std::uint32_t none = ~0U;
    std::array<std::uint32_t, 4> corners;  ///< into BeamSet::rays; the last may be `none`
    Spectrum flux = black();               ///< through the polygon, after the event [W]
    float first_share = 1;                 ///< of the flux, in the first triangle
    float offset = 0;                      ///< rays to and from the polygon end this far off it [m]
    std::uint32_t triangle = 0;            ///< of the first caster's mesh; the first one of a cell
    bool inside : 1 = false;   ///< goes through the medium behind the last caster's front side
    bool is_cell : 1 = false;  ///< a cell of a grid: its second triangle is the mesh's next
    /// Light of a part of the polygon does not go the set's way, as beyond the horizon of a curved surface.
    bool has_dark_part : 1 = false;
    bool front : 1 =
        true;  ///< where roots are searched: the light comes to the first caster's front
    /// Where roots are searched and the edge opposite the first corner is a chord of the horizon: the light of the polygon
    /// begins so far beyond it, in 65536ths of the distance from that corner.
    std::uint16_t beyond = 0;

    double share_beyond() const { return static_cast<double>(beyond) / 65536; }
    std::size_t triangle_count() const { return corners[3] == none ? 1 : 2; }
    /// Corners of one of its triangles.
    std::array<std::uint32_t, 3> triangle_corners(std::size_t which) const {
        return {corners[0], corners[1 + which], corners[2 + which]};
    }
    /// Of the first caster's mesh: where one of its triangles lies.
    std::uint32_t mesh_triangle(std::size_t which) const {
        return is_cell && which == 1 ? triangle + 1 : triangle;
    }
    /// Of the flux, in one of its triangles.
    double share_of(std::size_t which) const {
        if (triangle_count() == 1) return 1;
        return static_cast<double>(which == 0 ? first_share : 1 - first_share);
    }
};

/// What a caster has done with light.
struct SpecularEvent {
    std::uint32_t shape = 0;  ///< index into Scene::shapes
    bool refracted = false;   ///< or reflected
};

/// The rays that leave from the middles of a triangle's edges, (0, 1), (1, 2) and (2, 0).
using EdgeMiddles = std::array<VertexRay, 3>;

/// The beams of one light sample that have met the same casters, with the same events.
struct BeamSet {
    LightSample light;
    std::uint32_t caster = 0;         ///< the first: the polygons are its
    bool refracted = false;           ///< by the last
    std::vector<SpecularEvent> path;  ///< in the light's order
    std::array<Spectrum, 2> absorption = {black(),
                                          black()};  ///< of the last: outside, inside [1/m]
    std::vector<VertexRay> rays;                     ///< neighbouring beams share them, bit for bit
    std::vector<Beam> beams;                         ///< in the order of the mesh's triangles
    /// One a ray where the intensity is `refined`, else none.
    std::vector<RaySpread> spreads;
    /// One a ray where the light drifts (LightSample::drifts), else none: the ray at the shortest wavelength of
    /// the bin, and at the longest. Between them rays move linearly.
    std::array<std::vector<VertexRay>, 2> ends;
    /// One a triangle of a beam where roots are searched (RootSearch), else none; `triangle_room` a beam, those
    /// that it does not have without directions.
    std::vector<EdgeMiddles> middles;
    std::size_t triangle_room = 1;
    /// One a ray with `middles` after several events: where its light met the first surface.
    std::vector<Vec3> origins;
    /// One a beam with `spreads`: the other beam of its pair of triangles, or Beam::none.
    std::vector<std::uint32_t> partners;

    /// Rays of one of a beam's triangles.
    std::array<const VertexRay*, 3> triangle(const Beam& beam, std::size_t which) const {
        const auto [a, b, c] = beam.triangle_corners(which);
        return {&rays[a], &rays[b], &rays[c]};
    }
    /// Where the light of a ray met the first surface.
    const Vec3& origin(std::uint32_t ray) const {
        return origins.empty() ? rays[ray].position : origins[ray];
    }
    bool has_roots() const { return !middles.empty(); }
    /// Whether roots are searched in one of a beam's triangles; else its middles have no directions.
    bool has_roots(std::size_t beam, std::size_t which) const {
        return has_roots() && !middles_of(beam, which)[0].direction.isZero(0);
    }
    const EdgeMiddles& middles_of(std::size_t beam, std::size_t which) const {
        return middles[beam * triangle_room + which];
    }
    bool drifts() const { return !ends[0].empty(); }
    /// Places in the bin between which are all of its rays.
    std::span<const double> places() const {
        static constexpr std::array<double, 3> all = {0, -1, 1};
        return drifts() ? std::span(all).last(2) : std::span(all).first(1);
    }
    /// A ray at a place in the light's bin of wavelengths, from -1 to 1.
    VertexRay ray(std::uint32_t number, double place) const {
        if (!drifts()) return rays[number];
        const VertexRay& first = ends[0][number];
        const VertexRay& last = ends[1][number];
        const auto share = static_cast<float>((1 + place) / 2);
        return {(1 - share) * first.position + share * last.position,
                ((1 - share) * first.direction + share * last.direction).normalized()};
    }
    std::array<VertexRay, 3> triangle(const Beam& beam, std::size_t which, double place) const {
        const auto [a, b, c] = beam.triangle_corners(which);
        return {ray(a, place), ray(b, place), ray(c, place)};
    }
    std::uint64_t bytes() const {
        return (rays.size() + 2 * ends[0].size()) * sizeof(VertexRay) +
               beams.size() * sizeof(Beam) + spreads.size() * sizeof(RaySpread) +
               middles.size() * sizeof(EdgeMiddles) + origins.size() * sizeof(Vec3) +
               partners.size() * sizeof(std::uint32_t);
    }
};

/// Which beam of which set.
struct BeamNumber {
    std::uint32_t set = 0;
    std::uint32_t beam = 0;
};

}  // namespace caustics::beamtree

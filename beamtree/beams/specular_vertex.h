#pragma once

#include <array>
#include <cstdint>

#include "beamtree/beams/light_sample.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// What a specular surface does with light.
enum Event : std::size_t { reflection, refraction };
inline constexpr std::array<Event, 2> events = {reflection, refraction};

/// What the surface does with the light at one point.
struct SpecularVertex {
    bool front = false;  ///< the light arrives on the normal's side
    std::array<Vec3, 2> direction;
    std::array<Spectrum, 2> weight = {black(), black()};  ///< strength after each event
};

/// A point of a caster's mesh, with its interpolated normal, and what becomes of the light there.
struct MeshPoint {
    static constexpr std::uint32_t no_vertex = ~0U;
    Vec3 position;
    Vec3 normal;  ///< unit, or zero
    SpecularVertex bent;
    std::uint32_t vertex = no_vertex;  ///< of the mesh, where it is one
};

/// A triangle on a triangle of the mesh.
using MeshPiece = std::array<MeshPoint, 3>;
using PieceCorners = std::array<const MeshPoint*, 3>;

/// Bends the light of one sample at points of one caster [CC95 sec. 3.1], by the normal there.
class LightBender {
public:
    LightBender(const Scene& scene, std::uint32_t shape, const LightSample& light)
        : bsdf_(scene.shapes()[shape].bsdf), light_(light) {}

    /// The point with this normal, of any length.
    MeshPoint at(const Vec3& position, const Vec3& normal) const;
    /// What the surface does with light that has gone `distance` [m] to it, where the unit normal
    /// is this and the light lies along the unit direction `to_light`.
    SpecularVertex along(const Vec3& normal, const Vec3& to_light, float distance) const;
    /// Strength of the light that arrives there.
    Spectrum arriving(const Vec3& normal, const Vec3& to_light, float distance) const;
    /// The medium [1/m] that the light is in as it leaves the surface along a direction; null: none is known.
    const Spectrum* medium_after(const Vec3& normal, const Vec3& direction) const;
    /// (1 - t) a + t b; the same bits for (b, a, 1 - t) where t is 1/2.
    MeshPoint between(const MeshPoint& a, const MeshPoint& b, float t) const;
    /// The point of the piece with these barycentric weights.
    MeshPoint inside(const MeshPiece& piece, const Vec3& weights) const;
    /// The point of the piece straight below the light, or one near it on its rim; the middle for a
    /// light that is at no place.
    MeshPoint nearest_to_light(const MeshPiece& piece) const;
    /// Flux that the piece sends on [W]: strength x solid angle x mean weight. The mean of the
    /// corners' weights is right to second order where they are alike. Near total reflection, where
    /// Fresnel's shares run like a root, the surface is asked inside as well.
    Spectrum flux(const PieceCorners& corners, Event event) const;

private:
    const Bsdf& bsdf_;
    const LightSample& light_;
};

/// Whether three corners' weights differ by more than half of the least, so that their mean does not tell that
/// of what lies between.
bool weights_differ(const std::array<float, 3>& weights);
bool weights_differ(const PieceCorners& corners, Event event);

}  // namespace caustics::beamtree

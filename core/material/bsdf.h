#pragma once

#include <optional>
#include <variant>

#include "core/material/conductor.h"
#include "core/material/dielectric.h"
#include "core/material/diffuse.h"
#include "core/material/phong.h"
#include "core/material/schlick.h"

namespace caustics {

/// The mirror in a blend of a receiver's model with a conductor (Mitsuba's `blendbsdf`).
struct MirrorPart {
    float weight = 0;  ///< (0, 1): the conductor's share; the receiver's model has the rest
    Spectrum reflectance = Spectrum::Ones();
};

/// A surface's scattering. One-sided models (all but Dielectric) are black from behind unless
/// `twosided`, as in Mitsuba. A new model is a file of its own and a place in the list below. What is asked of
/// it: `text` and `read`, its keys in a scene file and itself; `to_mitsuba` and `to_povray`, where those know it;
/// of a receiver's, five functions that those below ask for, f_r, albedo, at, sample and pdf, and
/// `add_scattering_to`, what a map of all photons depends on, and `lobe_half_width` where it has a lobe; of a caster's, `split` (specular_split.h) and
/// `add_to`, what every photon map depends on; `medium` where it bounds two, and
/// `is_dispersive` where wavelengths part.
struct Bsdf {
    std::variant<Diffuse, Schlick, Phong, Dielectric, Conductor> model = Diffuse{};
    bool twosided = false;
    std::optional<MirrorPart> mirror = {};  ///< of a receiver's model alone
};

/// Casters are the surfaces with a perfectly specular part, receivers those that scatter light: a surface
/// with a mirror part is both.
bool is_caster(const Bsdf& bsdf);
bool is_receiver(const Bsdf& bsdf);
/// Whether light of different wavelengths leaves the surface in different ways.
bool is_dispersive(const Bsdf& bsdf);
/// Whether light arriving from the front (or the back) of the surface is scattered at all.
bool scatters_from(const Bsdf& bsdf, bool front);

/// The angle from the mirror direction at which a receiver's glossy lobe, seen straight on, has fallen to half [rad]; none
/// where it has no lobe, or one that never falls so far.
std::optional<float> lobe_half_width(const Bsdf& bsdf);

/// f_r [1/sr] of a receiver, without the cosine. `n` is the unit shading normal on the viewer's
/// side; `wo`, `wi` are unit and point away from the surface. 0 when either is below n.
Spectrum evaluate(const Bsdf& bsdf, const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi);

/// A copy of a receiver's bsdf with its textures evaluated at `uv`. It serves to evaluate many directions at one point. A caster's
/// bsdf is copied unchanged.
Bsdf bsdf_at(const Bsdf& bsdf, const Vec2& uv);

/// The model of a surface, without a mirror part, in the words of another program.
MitsubaBsdf to_mitsuba(const Bsdf& bsdf);
PovraySurface to_povray(const Bsdf& bsdf);

/// Directional-hemispherical reflectance of a receiver's texture (without a mirror part), for the albedo
/// layer; 1 for what is a caster alone.
Spectrum albedo(const Bsdf& bsdf, const Vec2& uv);

/// Importance sampling of f_r * cos for a receiver, by three numbers of [0, 1). Unit `wi`, or none when
/// the sample falls below n.
std::optional<Vec3> sample_direction(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, float u0,
                                     float u1, float u2);
/// Solid-angle density of sample_direction [1/sr].
float direction_pdf(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, const Vec3& wi);

}  // namespace caustics

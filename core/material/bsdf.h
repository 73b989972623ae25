#pragma once

#include <optional>
#include <variant>

#include "core/material/ior.h"
#include "core/material/texture.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics {

/// Lambert's law: f_r = reflectance / pi.
struct Diffuse {
    Texture reflectance = Spectrum(Spectrum::Constant(0.5F));
};

/// Schlick's model as [J96 (5)], [J96 (6)] print it, times `reflectance`, without anisotropy and
/// without Fresnel; alpha = 1 is broad, alpha -> 0 a mirror-like lobe. The printed t is always
/// +-1; here t = n.h with the normalised half vector. Not Lambertian at alpha = 1: the albedo
/// there is 5/4 - 2v/3, v = n.wo.
struct Schlick {
    Texture reflectance = Spectrum(Spectrum::Constant(0.5F));
    float alpha = 1;  ///< (0, 1]
};

/// A smooth interface between two lossless or absorbing media. The inside is the side away from
/// the geometric normal.
struct Dielectric {
    Ior int_ior = 1.5046F;
    Ior ext_ior = 1.000277F;
    Spectrum absorption = Spectrum::Zero();      ///< Beer's law inside [1/m]
    Spectrum ext_absorption = Spectrum::Zero();  ///< Beer's law outside [1/m]
    Spectrum specular_reflectance = Spectrum::Ones();
    Spectrum specular_transmittance = Spectrum::Ones();

    bool is_dispersive() const { return int_ior.is_dispersive() || ext_ior.is_dispersive(); }
    /// Index of refraction behind the interface over that before it, for light that comes to its front or
    /// back, at a wavelength [nm]; 0: as Ior::at.
    float relative_ior(bool front, float nm) const;
};

/// A perfect mirror (Mitsuba's `conductor` of material `none`).
struct Conductor {
    Spectrum specular_reflectance = Spectrum::Ones();
};

/// A surface's scattering. One-sided models (all but Dielectric) are black from behind unless
/// `twosided`, as in Mitsuba.
struct Bsdf {
    std::variant<Diffuse, Schlick, Dielectric, Conductor> model = Diffuse{};
    bool twosided = false;
};

/// Casters are the surfaces with a perfectly specular part; receivers are all others.
bool is_caster(const Bsdf& bsdf);
bool is_receiver(const Bsdf& bsdf);
/// Whether light of different wavelengths goes on from the surface in different ways.
bool is_dispersive(const Bsdf& bsdf);
/// Whether light arriving from the front (or the back) of the surface is scattered at all.
bool scatters_from(const Bsdf& bsdf, bool front);

/// f_r [1/sr] of a receiver, without the cosine. `n` is the unit shading normal on the viewer's
/// side; `wo`, `wi` are unit and point away from the surface. 0 when either is below n.
Spectrum evaluate(const Bsdf& bsdf, const Vec2& uv, const Vec3& n, const Vec3& wo, const Vec3& wi);

/// Directional-hemispherical reflectance of a receiver's texture, for the albedo layer; 1 for
/// casters.
Spectrum albedo(const Bsdf& bsdf, const Vec2& uv);

/// Importance sampling of f_r * cos for a receiver (cosine lobe, and for Schlick half of the
/// samples from the half-vector lobe Z(t)). Unit `wi`, or none when the sample falls below n.
std::optional<Vec3> sample_direction(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, float u0,
                                     float u1, float u2);
/// Solid-angle density of sample_direction [1/sr].
float direction_pdf(const Bsdf& bsdf, const Vec3& n, const Vec3& wo, const Vec3& wi);

}  // namespace caustics

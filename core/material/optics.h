#pragma once

#include <optional>

#include "core/material/bsdf.h"
#include "core/material/fresnel.h"
#include "core/material/specular_split.h"
#include "core/math/rng.h"
#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics {

/// Beer's law: the share of light left after `distance` [m] of a medium [1/m].
Spectrum transmittance(const Spectrum& absorption, float distance);

/// What a caster does with light along `w` (unit, away from the surface).
/// `ng`, `ns`: the surface's geometric and shading normals as stored (not turned towards w). `nm` is
/// the light's wavelength, for a dispersive dielectric; 0: as Ior::at.
SpecularSplit split_specular(const Bsdf& bsdf, const Vec3& ng, const Vec3& ns, const Vec3& w,
                             float nm = 0);

/// The light of a path that may have come to have one wavelength.
struct PathWavelength {
    float nm = 0;  ///< 0: all of them
    /// The number of [0, 1) that chooses the wavelength, where paths share them out among each other; none:
    /// drawn.
    std::optional<double> choice = {};

    /// Chooses one at the path's first dispersive interface, and weighs what the path carries by
    /// SampledWavelength::weight; does nothing elsewhere.
    void arrive_at(const Bsdf& bsdf, Rng& rng, Spectrum& carried);
};

/// Whether nothing is absorbed on the way through a medium of that absorption; nullptr: through none.
bool is_clear(const Spectrum* absorption);

/// Absorption [1/m] on the side of the surface that `w` points into; nullptr for surfaces that bound
/// no medium (all but dielectrics).
const Spectrum* medium_absorption(const Bsdf& bsdf, const Vec3& ng, const Vec3& w);

/// Absorption [1/m] where a path goes on from a surface along `w`, which it has come to through `before`: a mirror
/// keeps the path in its medium.
const Spectrum* medium_after(const Bsdf& bsdf, const Vec3& ng, const Vec3& w,
                             const Spectrum* before);

/// Beer's law along a traced segment: the medium is the one on the side of the surface where the
/// segment ends, else (it ends on no interface) where it starts, else none.
Spectrum segment_transmittance(const Spectrum* start_absorption, const Spectrum* end_absorption,
                               float distance);

}  // namespace caustics

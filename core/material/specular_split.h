#pragma once

#include "core/math/spectrum.h"
#include "core/math/vec.h"

namespace caustics {

/// What a perfectly specular surface does with light along `w` (unit, away from the surface):
/// up to two continuations. Directions are by the shading normal; one that would leave on the
/// wrong side of the geometric surface is dropped, and so is all light that arrives on different
/// sides by the two normals: its weight is lost (symmetrically for light and eye paths).
struct SpecularSplit {
    Vec3 reflected = Vec3::Zero();
    Vec3 refracted = Vec3::Zero();
    Spectrum reflected_weight = black();  ///< of flux; includes Fresnel and colour
    Spectrum refracted_weight = black();
    Spectrum lost_weight = black();  ///< of what was dropped
    float eta = 1;                   ///< ior on the far side / ior on w's side
};

/// Light that arrives along `w` where both normals agree on its side.
struct SpecularArrival {
    bool front = true;  ///< whether on the front side of the surface
    Vec3 ng;            ///< unit geometric normal, as stored
    Vec3 n;             ///< unit shading normal, on w's side
    Vec3 w;             ///< unit, away from the surface
    float nm = 0;       ///< wavelength; 0: as Ior::at
};

}  // namespace caustics

#pragma once

#include "core/caustic_estimator.h"
#include "core/known_shadows.h"
#include "core/math/rng.h"
#include "core/scene/scene.h"

namespace caustics {

/// The normal whose cosine weighs light that arrives.
enum class Cosine {
    shading,   ///< as pictures of smooth meshes show it
    geometric  ///< flux per area of the surface, as light paths bring it
};

/// One sample of the radiance that light arriving straight from the lights (L D) leaves along the
/// point's `wo`. Area lights by multiple importance sampling of light and BSDF (balance
/// heuristic). With opaque shadows every surface between casts a full one, specular ones too. With
/// transparent ones light goes straight through dielectrics, times what Fresnel's formulas let pass at
/// each (the angle taken on its thinner side) and Beer's law between. Light that meets none of them is absorbed by the
/// medium that its lamp shines into.
Spectrum direct_radiance(const Scene& scene, const ReceiverPoint& point, Rng& rng,
                         Shadows shadows = Shadows::opaque);

/// The same with opaque shadows, whose rays are spared where they are known. Counts them.
Spectrum direct_radiance(const Scene& scene, const ReceiverPoint& point, Rng& rng,
                         ShadowRays& rays);

/// The part of it that samples of lights bring, with opaque shadows. The rest is what rays along samples of the
/// BSDF meet of lights, times pdf / (met.pdf + pdf) of the direction.
Spectrum sampled_light(const Scene& scene, const ReceiverPoint& point, Rng& rng, Cosine cosine);

/// What a ray meets of lights, and the density with which sampled_light() chooses its direction [1/sr].
struct MetLight {
    Spectrum radiance = black();
    float pdf = 0;
};
/// At the first surface, or none, along a unit direction, as far away as `distance` [m].
MetLight met_light(const Scene& scene, const std::optional<SurfacePoint>& hit,
                   const Vec3& direction, float distance);

}  // namespace caustics

#pragma once

#include <optional>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/math/rng.h"
#include "core/scene/scene.h"

namespace caustics {

/// What an eye ray found first, for the albedo, normal and depth layers.
struct FirstHit {
    Spectrum albedo = black();
    Vec3 normal = Vec3::Zero();
    float depth = 0;  ///< distance from the eye [m]; 0 = nothing there
    bool caster = false;
};

/// A receiver point an eye path reached, and the share of its radiance that reaches the eye.
struct WeightedPoint {
    ReceiverPoint point;
    Spectrum weight;
    bool seen_directly = false;  ///< not by mirrors or through glass
};

/// The specular part S* E of one camera sample.
struct EyePath {
    FirstHit first;
    Spectrum emitted = black();  ///< L S* E: lights seen directly or through the chain
};

/// Follows a camera ray, which starts in a medium of that absorption [1/m] (eye_medium), through
/// specular surfaces to every receiver point it sees. A dielectric
/// splits the path while both parts matter, later one of them is drawn by its weight; radiance is
/// scaled by (n on the eye's side / n on the far side)^2 at each refraction and by Beer's law
/// along each segment. The points refer to `absorption` where nothing has changed the medium. Behind dispersive glass light has the wavelength that `wavelength` chooses, a
/// number of [0, 1); none: drawn. Appends the points found; their ids are left 0.
EyePath trace_eye_path(const Scene& scene, const Ray& camera_ray, const Spectrum& absorption,
                       Rng& rng, std::vector<WeightedPoint>& points,
                       std::optional<double> wavelength = {});

}  // namespace caustics

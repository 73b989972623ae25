#pragma once

#include "core/caustic_estimator.h"
#include "core/film.h"
#include "core/scene.h"

namespace caustics {

/// What a render counted.
struct RenderReport {
    Counters counters;  ///< of the method's queries and of the eye pass
};

struct Rendering {
    Film film;
    RenderReport report;
};

/// The eye pass, the same code and the same camera samples for every method: direct light, the
/// specular chains S* E with Fresnel, Beer's law and n^2 scaling, and at each receiver point the
/// method's caustic radiance. Layers as film.h. Adaptive sampling, where the scene's sampler asks for
/// it, takes its first samples everywhere and more where they scatter. Bit-identical for any number of threads.
Rendering render(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options);

}  // namespace caustics
